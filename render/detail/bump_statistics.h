/* Statistics of bumps that are smaller than a sample: the C counterpart of `Bumps` in detail.glsl. Tangent
 * space. Pure; threads: any. */
#ifndef TOILE_RENDER_DETAIL_BUMP_STATISTICS_H
#define TOILE_RENDER_DETAIL_BUMP_STATISTICS_H

#include "config/base/simd.h"
#include "render/detail/detail_terms.h"
#include "render/detail/options.h"

#include <cglm/struct.h>

/* A mean tangent-space normal, the variances of the slopes about it along u and v and their covariance, and
 * its length before normalisation. */
struct tl_bump_statistics {
    vec3s normal;
    float spread[3], length;
};

/* Statistics of a single normal. */
TL_INLINE struct tl_bump_statistics tl_bump_statistics_of_normal(vec3s normal)
{
    return (struct tl_bump_statistics){normal, {0, 0, 0}, 1};
}

/* Statistics of averaged moments (x, y, x^2, y^2) and `cross` (x y); slopes along u and v are multiplied by
 * `scale`. The variances and the covariance are those of [Olano and Baker 2010, eq. 5]. */
TL_INLINE struct tl_bump_statistics tl_bump_statistics_of_moments(vec4s moments, float cross,
                                                                  const float scale[2])
{
    float z = sqrtf(tl_maxf(1 - moments.z - moments.w, 0));
    struct tl_bump_statistics bumps = {
        .normal = {{scale[0] * moments.x, scale[1] * moments.y, z}},
        .spread = {scale[0] * scale[0] * tl_maxf(moments.z - moments.x * moments.x, 0),
                   scale[1] * scale[1] * tl_maxf(moments.w - moments.y * moments.y, 0),
                   scale[0] * scale[1] * (cross - moments.x * moments.y)}};
    bumps.length = sqrtf(tl_minf(tl_maxf(1 - bumps.spread[0] - bumps.spread[1], 0.0025f), 1));
    return bumps;
}

/* The sum of two layers of bumps: slopes add as those of summed heights do, and so do their variances. */
TL_INLINE struct tl_bump_statistics tl_bump_statistics_add(const struct tl_bump_statistics *a,
                                                           const struct tl_bump_statistics *b)
{
    vec3s n = a->normal, m = b->normal;
    return (struct tl_bump_statistics){
        .normal = {{n.x * m.z + m.x * n.z, n.y * m.z + m.y * n.z, n.z * m.z}},
        .spread = {a->spread[0] + b->spread[0], a->spread[1] + b->spread[1], a->spread[2] + b->spread[2]},
        .length = a->length * b->length};
}

/* Roughness 1 - g of a surface with these bumps, by the minification of `params`; `view` is in tangent
 * space. */
TL_INLINE float tl_bump_statistics_roughness(const struct tl_detail_params *params, float rough,
                                             const struct tl_bump_statistics *bumps, vec3s view)
{
    if (params->minify == TL_DETAIL_MINIFY_NONE)
        return rough;
    if (params->minify == TL_DETAIL_MINIFY_TOKSVIG) {
        float variance = detail_variance(bumps->length);
        return detail_widened(rough, variance, variance, 1);
    }
    float square = view.x * view.x + view.y * view.y;
    float share = square > 1e-12f ? view.x * view.x / square : 0.5f;
    float both = square > 1e-12f ? 2 * bumps->spread[2] * view.x * view.y / square : 0;
    float along = bumps->spread[0] * share + bumps->spread[1] * (1 - share) + both;
    float across = bumps->spread[0] * (1 - share) + bumps->spread[1] * share - both;
    return detail_widened(rough, along, across, fabsf(view.z));
}

/* The sum of maps and of these bumps in squared widths of facets along axis 0 (u) or 1 (v). `own_rough` is
 * that of the material, `rough` with its maps and yarns. */
TL_INLINE float tl_bump_statistics_widening(const struct tl_detail_params *params, float own_rough,
                                            float rough, const struct tl_bump_statistics *bumps, int axis)
{
    float variance = params->minify == TL_DETAIL_MINIFY_LEAN      ? bumps->spread[axis]
                     : params->minify == TL_DETAIL_MINIFY_TOKSVIG ? detail_variance(bumps->length)
                                                                  : 0;
    return detail_widening(own_rough, rough, variance);
}

/* Their part in the product of the widths along u and v: off the diagonal of the matrix that has the
 * squared widths on it. */
TL_INLINE float tl_bump_statistics_shear(const struct tl_detail_params *params,
                                         const struct tl_bump_statistics *bumps)
{
    return params->minify == TL_DETAIL_MINIFY_LEAN ? 2 * bumps->spread[2] : 0;
}

#endif
