/* Draws a view's legend (render/inspect/legend.h) on a picture. Threads: any, each with pictures of its own.
 */
#ifndef TOILE_APP_REPORT_LEGEND_H
#define TOILE_APP_REPORT_LEGEND_H

#include "assets/base/image.h"
#include "render/inspect/legend.h"

/* Draws the legend into the lower left corner of a U8 picture of 3 channels, on a dark ground. Draws nothing
 * and returns false where the picture is too small. An empty legend (of TL_VIEW_LIGHT) draws nothing and
 * returns true. */
bool tl_legend_draw(const struct tl_legend *legend, tl_image *picture);

/* Prints a value of the legend's scale with three digits: "-2.5", "0", "10". Rounding errors about 0, up to a
 * thousandth of the scale, are printed as 0. */
void tl_legend_number(const struct tl_legend *legend, float value, char out[16]);

#endif
