/* Fabric detail for the reference renderer: the definitions of detail.glsl with exact area averages, and
 * relief by a fine march at the finest level of the field. Shadows of bumps are not traced. Pure once made;
 * threads: any. */
#ifndef TOILE_RENDER_REFERENCE_DETAIL_H
#define TOILE_RENDER_REFERENCE_DETAIL_H

#include "render/detail/bump_statistics.h"
#include "render/detail/detail.h"
#include "render/gpu/map_texture.h"

/* The moments of a normal map: (x, y, x^2, y^2), and x y. */
struct tl_moment_map {
    const tl_image *of;
    tl_image image, cross_image;
    struct tl_map_texture texture, cross_texture;
};

struct tl_reference_detail {
    struct tl_detail_params params;
    size_t count;
    struct tl_moment_map **items; /* moments of normal maps, which several materials may share; owned */
};
/* Frees and zeroes. */
void tl_reference_detail_release(struct tl_reference_detail *detail);

/* The moments of a normal map, made at the first call for each map. NULL when `normals` is NULL or no option
 * needs them. */
const struct tl_moment_map *tl_reference_moments(struct tl_reference_detail *detail, const tl_image *normals);

/* The shift in UV by parallax or relief. `view` is in the tangent space of the front; `side` is -1 for a back
 * face. */
vec2s tl_reference_shift(const struct tl_detail_params *params, const struct tl_detail_heights *heights,
                         vec2s uv, float uv_metres, vec3s view, float side);

#endif
