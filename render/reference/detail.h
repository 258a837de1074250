/* Fabric detail as the oracle sees it: the definitions of detail.glsl by exact area averages, and relief by a
 * fine march at the field's finest level. Shadows of bumps are not traced. Pure once made; threads: any. */
#ifndef TOILE_RENDER_REFERENCE_DETAIL_H
#define TOILE_RENDER_REFERENCE_DETAIL_H

#include "render/detail/detail.h"
#include "render/gpu/map_texture.h"

struct tl_reference_detail {
    struct tl_detail_params params;
    size_t count;
    struct tl_moments **items; /* moments of normal maps that several materials may share; owned */
};
void tl_reference_detail_release(struct tl_reference_detail *detail);

/* Moments of a normal map; NULL for NULL, or when no option asks for them. */
const struct tl_map_texture *tl_reference_moments(struct tl_reference_detail *detail,
                                                  const tl_image *normals);

/* A tangent-space normal, the variances of its slopes, the length of the mean. */
struct tl_bumps {
    vec3s normal;
    float spread[2], length;
};
struct tl_bumps tl_bumps_of(vec3s normal);
struct tl_bumps tl_bumps_averaged(vec4s moments, float scale);
/* Slopes added as the heights behind them would be. */
struct tl_bumps tl_bumps_added(const struct tl_bumps *a, const struct tl_bumps *b);
/* 1 - g over averaged normals; `view` in tangent space. */
float tl_bumps_rough(const struct tl_detail_params *params, float rough, const struct tl_bumps *bumps,
                     vec3s view);

/* How far detail moves the UV that is seen; `view` in the outside's tangent space, `side` -1 for a back. */
vec2s tl_reference_shift(const struct tl_detail_params *params, const struct tl_detail_heights *heights,
                         vec2s uv, float uv_metres, vec3s view, float side);

#endif
