/* Yarns that differ from one another along the whole cloth: the terms of yarn_terms.glsl in C, from the same
 * text. Warp yarns count along u, weft yarns along v; both tables repeat, after numbers of yarns without a
 * common divisor. Pure; threads: any. */
#ifndef TOILE_RENDER_DETAIL_YARNS_H
#define TOILE_RENDER_DETAIL_YARNS_H

#include "assets/base/material.h"
#include "render/gpu/vectors.h"

static inline float yarn_sum(const float *sums, float entry)
{
    return sums[(int)entry];
}

#define YARN_TABLES    sums,
#define YARN_TABLES_IN const float *sums,

#include "render/gpu/terms_begin.h"

#include "render/detail/yarn_terms.glsl"

#include "render/gpu/terms_end.h"

#undef YARN_TABLES
#undef YARN_TABLES_IN

/* The factor on colour at a point of a surface whose UV unit is `uv_metres`; `across` and `down`: how UV
 * changes to the next samples. */
static inline float tl_yarn_factor(const struct tl_yarns *yarns, float uv_metres, vec2s uv, vec2s across,
                                   vec2s down)
{
    const float x = uv_metres / yarns->pitch_m[0], y = uv_metres / yarns->pitch_m[1];
    return yarn_factor(yarns->sums, TL_WARP_YARNS, TL_WEFT_YARNS, x * uv.x, y * uv.y,
                       x * sqrtf(across.x * across.x + down.x * down.x),
                       y * sqrtf(across.y * across.y + down.y * down.y));
}

#endif
