/* tl_lobes_fetch as inline text, for loops over pixels: what is compiled for each instruction set must be
 * inline (config/base/simd.h). Pure; threads: any. */
#ifndef TOILE_RENDER_ENV_LOBES_FETCH_H
#define TOILE_RENDER_ENV_LOBES_FETCH_H

#include "render/env/lobes.h"
#include "render/env/quad.h"

#include <assert.h>
#include <math.h>

/* A point of the unfolded octahedron, u and v in [0, 1]. */
struct tl_octahedral_place {
    float u, v;
};

/* Fetches for a direction of any length. */
TL_INLINE struct tl_octahedral_place tl_octahedral_place(float x, float y, float z)
{
    float scale = 0.5f / (fabsf(x) + fabsf(y) + fabsf(z));
    float u = x * scale, v = z * scale;
    /* Below the horizon 1 - |v| = |u| + |y|. */
    float outwards = tl_maxf(-y, 0) * scale;
    u += copysignf(outwards, u);
    v += copysignf(outwards, v);
    return (struct tl_octahedral_place){u + 0.5f, v + 0.5f};
}

/* The four texels about a place: the index of the first, and the shares of the second column and row. */
struct tl_lobe_texels {
    int first;
    float right, below;
};

TL_INLINE struct tl_lobe_texels tl_lobe_texels_about(int side, struct tl_octahedral_place place)
{
    float x = place.u * (float)side + 0.5f, y = place.v * (float)side + 0.5f, last = (float)side + 0.5f;
    x = tl_minf(tl_maxf(x, 0), last); /* NaN becomes 0, too */
    y = tl_minf(tl_maxf(y, 0), last);
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

TL_INLINE tl_quad tl_lobe_map_fetch(const struct tl_lobe_map *map, struct tl_octahedral_place place)
{
    return tl_lobe_texels_mean(map, tl_lobe_texels_about(map->side, place));
}

/* The exponents of the blend must exist. RGB, 0. */
TL_INLINE tl_quad tl_lobes_fetch_quad(const struct tl_lobes *lobes, struct tl_octahedral_place place,
                                      struct tl_exponent_blend blend)
{
    tl_quad colour = tl_lobe_map_fetch(&lobes->maps[blend.index], place);
    if (blend.weight > 0) /* the next map need not exist otherwise */
        colour += blend.weight * (tl_lobe_map_fetch(&lobes->maps[blend.index + 1], place) - colour);
    return colour;
}

#endif
