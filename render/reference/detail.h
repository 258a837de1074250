/* Fabric detail as the oracle sees it: the definitions of detail.glsl by exact area averages, and relief by a
 * fine march at the field's finest level. Shadows of bumps are not traced. Pure once made; threads: any. */
#ifndef TOILE_RENDER_REFERENCE_DETAIL_H
#define TOILE_RENDER_REFERENCE_DETAIL_H

#include "render/detail/detail.h"
#include "render/gpu/map_texture.h"

struct tl_reference_detail {
    struct tl_detail_params params;
    size_t count;
    struct tl_moment_map **items; /* moments of normal maps that several materials may share; owned */
};
void tl_reference_detail_release(struct tl_reference_detail *detail);

/* Moments of a normal map; NULL for NULL, or when no option asks for them. */
const struct tl_map_texture *tl_reference_moments(struct tl_reference_detail *detail,
                                                  const tl_image *normals);

/* A tangent-space normal, the variances of its slopes, the length of the mean. */
struct tl_bump_statistics {
    vec3s normal;
    float spread[2], length;
};
struct tl_bump_statistics tl_bump_statistics_of_normal(vec3s normal);
struct tl_bump_statistics tl_bump_statistics_of_moments(vec4s moments, float scale);
/* Slopes added as the heights behind them would be. */
struct tl_bump_statistics tl_bump_statistics_add(const struct tl_bump_statistics *a,
                                                 const struct tl_bump_statistics *b);
/* 1 - g over averaged normals; `view` in tangent space. */
float tl_bump_statistics_roughness(const struct tl_detail_params *params, float rough,
                                   const struct tl_bump_statistics *bumps, vec3s view);

/* How far detail moves the UV that is seen; `view` in the outside's tangent space, `side` -1 for a back. */
vec2s tl_reference_shift(const struct tl_detail_params *params, const struct tl_detail_heights *heights,
                         vec2s uv, float uv_metres, vec3s view, float side);

#endif
