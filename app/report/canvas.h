/* Boxes and words on a picture, for charts that are PNG files. Pixels from the top left; colours are sRGB,
 * 0xRRGGBB. Pure. */
#ifndef TOILE_APP_REPORT_CANVAS_H
#define TOILE_APP_REPORT_CANVAS_H

#include "assets/base/image.h"

#define TL_CANVAS_LETTER 14 /* height of a line of text */

tl_image tl_canvas_create(int width, int height, uint32_t colour); /* U8, 3 channels */

/* What lies outside of the picture is cut off. */
void tl_canvas_box(tl_image *canvas, int x, int y, int width, int height, uint32_t colour);

/* ASCII, with its upper left corner at x, y. */
void tl_canvas_text(tl_image *canvas, int x, int y, const char *text, uint32_t colour);
int tl_canvas_text_width(const char *text);
/* The same with letters `scale` times as large as the smallest, which are 7 pixels high; the above have 2. */
void tl_canvas_words(tl_image *canvas, int x, int y, int scale, const char *text, uint32_t colour);
int tl_canvas_words_width(int scale, const char *text);

#endif
