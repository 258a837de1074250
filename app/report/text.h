/* Text on a picture, set by Pango and drawn by Cairo: any script that a font on this machine has.
 *
 * Text is UTF-8; bytes that are not UTF-8 are drawn as U+FFFD, and control characters such as a newline as
 * symbols. Lengths are pixels, x to the right and y down; colours are sRGB, 0xRRGGBB. A line stands in an em
 * square: y is the top of the square, the baseline lies at 0.8 of its height, and accents of capitals reach
 * over its top. Line heights thus do not depend on the fonts; widths do, so pictures with text are equal only
 * on machines with the same fonts. Errors: none; letters that no font has are drawn as boxes with their code
 * and logged as a warning. Threads: any, each with pictures of its own. */
#ifndef TOILE_APP_REPORT_TEXT_H
#define TOILE_APP_REPORT_TEXT_H

#include "assets/base/image.h"

enum tl_text_align { TL_TEXT_LEFT, TL_TEXT_CENTRE, TL_TEXT_RIGHT };

struct tl_text_style {
    int size; /* of the em square */
    uint32_t colour;
    int width; /* the text is wrapped to this width and ends in an ellipsis where it is too long; 0: no limit
                */
    enum tl_text_align align; /* within `width`, which must then not be 0 */
    int lines;                /* most lines; 0 counts as 1 */
    int leading;              /* from one baseline to the next; used where lines > 1 */
};

struct tl_text_extent {
    int width;   /* of the widest line */
    int lines;   /* at least 1, also of empty text */
    int unknown; /* letters that no font on this machine has */
};

/* The space that tl_text_draw takes. */
struct tl_text_extent tl_text_measure(const struct tl_text_style *style, const char *text);

/* Draws the text on a U8 picture of 3 channels, with the left upper corner of its first line at x, y. Parts
 * outside of the picture are cut off. */
void tl_text_draw(tl_image *picture, int x, int y, const struct tl_text_style *style, const char *text);

#endif
