/* Boxes and labels on a picture, for charts that are PNG files. Lengths are pixels, x to the right and y down
 * from the upper left corner; colours are sRGB, 0xRRGGBB. Shapes outside of the picture are cut off. Errors:
 * none. Threads: any, each with pictures of its own. */
#ifndef TOILE_APP_REPORT_CANVAS_H
#define TOILE_APP_REPORT_CANVAS_H

#include "assets/base/image.h"

#define TL_CANVAS_LETTER 16 /* height of a label: its em square */

/* New U8 picture of 3 channels, filled with one colour; release it with tl_image_release. */
tl_image tl_canvas_create(int width, int height, uint32_t colour);

/* Fills a box whose upper left corner is x, y. */
void tl_canvas_box(tl_image *canvas, int x, int y, int width, int height, uint32_t colour);

/* Draws one line of text, TL_CANVAS_LETTER high (app/report/text.h), with its upper left corner at x, y. */
void tl_canvas_text(tl_image *canvas, int x, int y, const char *text, uint32_t colour);
int tl_canvas_text_width(const char *text);

#endif
