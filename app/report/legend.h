/* A view's legend (render/inspect/legend.h) on a picture. Pure. */
#ifndef TOILE_APP_REPORT_LEGEND_H
#define TOILE_APP_REPORT_LEGEND_H

#include "assets/base/image.h"
#include "render/inspect/legend.h"

/* Draws it into the lower left corner of a U8 RGB picture, on a dark ground. False when the picture is too
 * small: it is left as it was. An empty legend draws nothing. */
bool tl_legend_draw(const struct tl_legend *legend, tl_image *picture);

/* Text of a value on the scale: "-2.5", "0", "10"; `out` has 16 bytes. */
void tl_legend_number(const struct tl_legend *legend, float value, char out[16]);

#endif
