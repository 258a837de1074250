/* Fabric detail for the reference renderer: the definitions of detail.glsl with exact area averages, and
 * relief by a fine march at the finest level of the field. Shadows of bumps are not traced. Pure once made;
 * threads: any. */
#ifndef TOILE_RENDER_REFERENCE_DETAIL_H
#define TOILE_RENDER_REFERENCE_DETAIL_H

#include "render/detail/detail.h"
#include "render/gpu/map_texture.h"

struct tl_reference_detail {
    struct tl_detail_params params;
    size_t count;
    struct tl_moment_map **items; /* moments of normal maps, which several materials may share; owned */
};
/* Frees and zeroes. */
void tl_reference_detail_release(struct tl_reference_detail *detail);

/* The moments of a normal map, made at the first call for each map. NULL when `normals` is NULL or no option
 * needs them. */
const struct tl_map_texture *tl_reference_moments(struct tl_reference_detail *detail,
                                                  const tl_image *normals);

/* A mean tangent-space normal, the variances of the slopes about it, and its length before normalisation. */
struct tl_bump_statistics {
    vec3s normal;
    float spread[2], length;
};
/* Statistics of a single normal. */
struct tl_bump_statistics tl_bump_statistics_of_normal(vec3s normal);
/* Statistics of averaged moments (x, y, x^2, y^2); slopes are multiplied by `scale`. */
struct tl_bump_statistics tl_bump_statistics_of_moments(vec4s moments, float scale);
/* The sum of two layers of bumps: slopes add as those of summed heights do, and so do their variances. */
struct tl_bump_statistics tl_bump_statistics_add(const struct tl_bump_statistics *a,
                                                 const struct tl_bump_statistics *b);
/* Roughness 1 - g of a surface with these bumps, by the minification of `params`; `view` is in tangent
 * space. */
float tl_bump_statistics_roughness(const struct tl_detail_params *params, float rough,
                                   const struct tl_bump_statistics *bumps, vec3s view);

/* The shift in UV by parallax or relief. `view` is in the tangent space of the front; `side` is -1 for a back
 * face. */
vec2s tl_reference_shift(const struct tl_detail_params *params, const struct tl_detail_heights *heights,
                         vec2s uv, float uv_metres, vec3s view, float side);

#endif
