/* tl_lobes_fetch as inline text, for loops over pixels: what is compiled for each instruction set must be
 * inline (config/base/simd.h). Pure; threads: any. */
#ifndef TOILE_RENDER_ENV_LOBES_FETCH_H
#define TOILE_RENDER_ENV_LOBES_FETCH_H

#include "render/env/exponent.h"
#include "render/env/lobes.h"
#include "render/env/quad.h"

/* The four texels about a place: the index of the first, and the shares of the second column and row. */
struct tl_lobe_texels {
    int first;
    float right, below;
};

TL_INLINE struct tl_lobe_texels tl_lobe_texels_about(int side, vec2s place)
{
    float x = lobe_texel(place.x, (float)side), y = lobe_texel(place.y, (float)side);
    int column = (int)x, row = (int)y;
    return (struct tl_lobe_texels){row * (side + 2) + column, x - (float)column, y - (float)row};
}

TL_INLINE tl_quad tl_lobe_texels_mean(const struct tl_lobe_map *map, struct tl_lobe_texels at)
{
    const tl_quad *top = (const tl_quad *)map->texels + at.first;
    const tl_quad *bottom = top + map->side + 2;
    tl_quad upper = top[0] + at.right * (top[1] - top[0]),
            lower = bottom[0] + at.right * (bottom[1] - bottom[0]);
    return upper + at.below * (lower - upper);
}

TL_INLINE tl_quad tl_lobe_map_fetch(const struct tl_lobe_map *map, vec2s place)
{
    return tl_lobe_texels_mean(map, tl_lobe_texels_about(map->side, place));
}

/* The exponents of the blend must exist. RGB, 0. */
TL_INLINE tl_quad tl_lobes_fetch_quad(const struct tl_lobes *lobes, vec2s place,
                                      struct tl_exponent_blend blend)
{
    tl_quad colour = tl_lobe_map_fetch(&lobes->maps[blend.index], place);
    if (blend.weight > 0) /* the next map need not exist otherwise */
        colour += blend.weight * (tl_lobe_map_fetch(&lobes->maps[blend.index + 1], place) - colour);
    return colour;
}

#endif
