/* The environment convolved with one lobe, resampled to a picture of the sphere in any layout, with its mip
 * levels. Pure; results do not depend on the number of threads. */
#ifndef TOILE_RENDER_ENVMAP_PREFILTERED_MAP_H
#define TOILE_RENDER_ENVMAP_PREFILTERED_MAP_H

#include "render/env/lobes.h"
#include "render/env/mip_levels.h"

/* [level_count] pictures of [height][width][4]. Released by tl_prefiltered_map_release. */
struct tl_prefiltered_map {
    float *texels[TL_MIP_LEVELS_MAX];
    int level_count;
};

/* E(d, s) for the exponent with index `exponent` (env/lobes.h; TL_EXPONENT_COUNT: the environment itself, the
 * mean of four look-ups per texel). d is the direction of a texel, turned by `turn` into the frame of the
 * lobes. Texels off the sphere get the value of the direction that the layout assigns to them. */
struct tl_prefiltered_map tl_prefiltered_map_make(const struct tl_mip_levels *levels,
                                                  const struct tl_lobes *lobes, int exponent, mat3s turn);
/* Frees and zeroes. */
void tl_prefiltered_map_release(struct tl_prefiltered_map *picture);

#endif
