/* Pictures of the sphere from one layout into another, keeping their light. Pure; results do not depend on
 * the number of threads. */
#ifndef TOILE_RENDER_ENV_CONVERT_H
#define TOILE_RENDER_ENV_CONVERT_H

#include "assets/base/image.h"
#include "render/env/layout.h"

/* The size at which `to` holds about as many texels as `from` does; cube 1 : lat-long 2 : paraboloid 2 :
 * sphere 3 : octahedral 3, so that going there and back restores the size. At least 1. */
int tl_convert_size(const struct tl_sphere_map *from, enum tl_layout to);

/* `image` (F32, RGB, finite, laid out as `from` says) as `to`. Every texel of the result is a mean of the
 * texels that it covers, weighted by what they have in common: a constant stays constant to rounding, and no
 * value leaves the range of the input. Every source texel gives away its exact solid angle: *error (may be
 * NULL) is the largest relative error of that, which bounds the error of the total power of any light in any
 * channel; it is below TL_CONVERT_ERROR, but for results of a few dozen texels (a cube of size 1: 1e-2).
 * Memory: 12 bytes for each pair of texels that meet and 24 for each texel. Shows its progress; an image
 * without texels when it was interrupted (config/interrupt.h). */
#define TL_CONVERT_ERROR 1e-3
tl_image tl_image_convert(const tl_image *image, const struct tl_sphere_map *from,
                          const struct tl_sphere_map *to, double *error);

#endif
