/* A height field over the tangent plane of a surface, and its visibility: parallax, relief, shadows [Wimmer
 * n.d.]. The counterpart of detail.glsl on the CPU.
 *
 * Tangent space: x along u, y along minus v, z outwards; metres; unit directions towards the viewer or the
 * light. Heights are above the surface of the mesh. Positions are in repeats of the map (uv of its texels).
 * Borrows the image; pure; threads: any. */
#ifndef TOILE_RENDER_DETAIL_FIELD_H
#define TOILE_RENDER_DETAIL_FIELD_H

#include "assets/base/image.h"

#include <cglm/struct.h>

struct tl_height_field {
    const tl_image *heights; /* F32 x1, metres */
    bool clamp_u, clamp_v;   /* else periodic */
    float repeats_per_m[4];  /* rows of the matrix from (x, y) in metres to repeats */
    float low_m, high_m;     /* of all heights */
    bool turned_over;        /* the sheet from below: heights are negated */
    const tl_image *cones;   /* from tl_bake_cones, for relief; else NULL */
};

/* The field of a map of size `width_m` x `height_m` on the surface. All heights must be finite. */
struct tl_height_field tl_height_field_make(const tl_image *heights, float width_m, float height_m,
                                            bool clamp_u, bool clamp_v);

/* The same sheet seen from its back. */
struct tl_height_field tl_height_field_back(const struct tl_height_field *field);

/* Height at uv, bilinear as GL reads level 0. */
float tl_field_height(const struct tl_height_field *field, vec2s uv);
/* uv displaced along the surface by (x_m, y_m). */
vec2s tl_field_moved(const struct tl_height_field *field, vec2s uv, float x_m, float y_m);

/* Parallax mapping: T_n = T_0 + h V_xy / V_z, or without the division (`limited`). The height at uv is
 * assumed for its whole neighbourhood. */
vec2s tl_field_parallax(const struct tl_height_field *field, vec2s uv, vec3s view, bool limited);

/* The hit of a ray on the field, for the view ray through uv on the mesh. */
struct tl_relief {
    vec2s uv;
    float height_m;
};
/* Relief mapping as in the shaders: at most `steps` cone steps from high_m to low_m, then `refine` bisections
 * of the step in which the ray went below the field, then linear interpolation. The field must have cones. */
struct tl_relief tl_field_relief(const struct tl_height_field *field, vec2s uv, vec3s view, int steps,
                                 int refine);
/* The reference for it: `steps` of equal height, then bisection to convergence. */
struct tl_relief tl_field_march(const struct tl_height_field *field, vec2s uv, vec3s view, int steps);

/* Visibility of a light from the field at uv, 0 or 1, by `steps` of equal height up to high_m, or as far as
 * DETAIL_REACH. */
float tl_field_lit(const struct tl_height_field *field, vec2s uv, vec3s light, int steps);

/* True where uv lies outside of a map that does not repeat; used to clip silhouettes. */
bool tl_field_is_outside(const struct tl_height_field *field, vec2s uv);

#endif
