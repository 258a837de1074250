/* The share of a sun that the pixels near the edge of its shadow see. */
#ifndef TOILE_RENDER_SHADE_SUN_PENUMBRA_INTERNAL_H
#define TOILE_RENDER_SHADE_SUN_PENUMBRA_INTERNAL_H

#include "render/shade/sun_pixels.h"

/* Fills `visible` [height][width] of a sun from the states of its pixels; those that may lie in a penumbra
 * get more rays. Returns their number. */
size_t tl_sun_soften(const struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request, int sun,
                     float *visible);

#endif
