/* An environment's light through lobes, poured into a picture of the sphere in any layout, with its mip
 * levels. Pure; results do not depend on the number of threads. */
#ifndef TOILE_RENDER_ENVMAP_PREFILTERED_MAP_H
#define TOILE_RENDER_ENVMAP_PREFILTERED_MAP_H

#include "render/env/lobes.h"
#include "render/env/mip_levels.h"

/* One picture: [levels] of [height][width][4]. */
struct tl_prefiltered_map {
    float *texels[TL_MIP_LEVELS_MAX];
    int level_count;
};

/* E(d, s) for the exponent numbered `exponent` (env/lobes.h; TL_EXPONENT_COUNT: the environment itself, the
 * mean of four look-ups a texel), d being a texel's direction turned by `turn` into the lobes' frame. Texels
 * off the sphere show what the layout says lies in their direction. */
struct tl_prefiltered_map tl_prefiltered_map_make(const struct tl_mip_levels *levels,
                                                  const struct tl_lobes *lobes, int exponent, mat3s turn);
void tl_prefiltered_map_release(struct tl_prefiltered_map *picture);

#endif
