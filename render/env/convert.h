/* Converts pictures of the sphere between layouts, conserving their light. Pure; results do not depend on the
 * number of threads. */
#ifndef TOILE_RENDER_ENV_CONVERT_H
#define TOILE_RENDER_ENV_CONVERT_H

#include "assets/base/image.h"
#include "render/env/layout.h"

/* The size at which `to` has about as many texels as `from`, in the ratios cube 1 : lat-long 2 : paraboloid 2
 * : sphere 3 : octahedral 3, so that converting there and back restores the size. At least 1. */
int tl_convert_size(const struct tl_sphere_map *from, enum tl_layout to);

/* Converts `image` (F32, RGB, finite, laid out as `from`) to the layout `to`. Every texel of the result
 * is the mean of the source texels that it covers, weighted by their common solid angle, so a constant stays
 * constant to rounding and no value leaves the range of the input. Every source texel distributes its exact
 * solid angle. *error (may be NULL) is the largest relative error of that; it bounds the relative error of
 * the total power in any channel. It is below TL_CONVERT_ERROR except for results of a few dozen texels (a
 * cube of size 1: 1e-2). Memory: 12 bytes for each pair of texels that overlap and 24 bytes for each texel.
 * Reports progress. Returns an image without texels when interrupted (config/base/interrupt.h). */
#define TL_CONVERT_ERROR 1e-3
/* Bytes that it takes at most, its result included. */
uint64_t tl_convert_bytes(const struct tl_sphere_map *from, const struct tl_sphere_map *to);
tl_image tl_image_convert(const tl_image *image, const struct tl_sphere_map *from,
                          const struct tl_sphere_map *to, double *error);

#endif
