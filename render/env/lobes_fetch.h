/* tl_lobes_fetch as inline text, for loops over pixels: what is compiled for each instruction set must be
 * inline (config/simd.h). Pure; threads: any. */
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

/* Of a direction of any length. */
TL_INLINE struct tl_octahedral_place tl_octahedral_place(float x, float y, float z)
{
    float scale = 0.5f / (fabsf(x) + fabsf(y) + fabsf(z));
    float u = x * scale, v = z * scale;
    /* Below the horizon 1 - |v| = |u| + |y|. */
    float outwards = y < 0 ? -y * scale : 0;
    u += copysignf(outwards, u);
    v += copysignf(outwards, v);
    return (struct tl_octahedral_place){u + 0.5f, v + 0.5f};
}

TL_INLINE tl_quad tl_lobe_map_fetch(const struct tl_lobe_map *map, struct tl_octahedral_place place)
{
    float x = place.u * (float)map->side + 0.5f, y = place.v * (float)map->side + 0.5f,
          last = (float)map->side + 0.5f;
    x = x > 0 ? x < last ? x : last : 0; /* NaN becomes 0, too */
    y = y > 0 ? y < last ? y : last : 0;
    int column = (int)x, row = (int)y;
    float right = x - (float)column, below = y - (float)row;
    const tl_quad *top =
        (const tl_quad *)map->texels + (size_t)row * (size_t)(map->side + 2) + (size_t)column;
    const tl_quad *bottom = top + map->side + 2;
    tl_quad upper = top[0] + right * (top[1] - top[0]), lower = bottom[0] + right * (bottom[1] - bottom[0]);
    return upper + below * (lower - upper);
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
