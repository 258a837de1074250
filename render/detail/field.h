/* A height field over the tangent plane of a surface, and how it is seen: parallax [004], relief [004],
 * shadow. The pure counterpart of detail.glsl.
 *
 * Tangent space: x along u, y along minus v, z outwards; metres; directions unit, towards the viewer or the
 * light. Heights are over the mesh's own surface. Places are in repeats of the map (uv of its texels).
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
    bool turned_over;        /* the sheet from below: heights count downwards */
    const tl_image *cones;   /* of tl_bake_cones, for relief; else NULL */
};

/* A map that is `width_m` x `height_m` large on the surface. Heights that are not finite are not allowed. */
struct tl_height_field tl_height_field_make(const tl_image *heights, float width_m, float height_m,
                                            bool clamp_u, bool clamp_v);

/* The same sheet seen from its back. */
struct tl_height_field tl_height_field_back(const struct tl_height_field *field);

/* Bilinear, as GL reads level 0. */
float tl_field_height(const struct tl_height_field *field, vec2s uv);
/* uv moved along the surface. */
vec2s tl_field_moved(const struct tl_height_field *field, vec2s uv, float x_m, float y_m);

/* T_n = T_0 + h V_xy / V_z, or without the division: the height at uv is taken for that of all around it. */
vec2s tl_field_parallax(const struct tl_height_field *field, vec2s uv, vec3s view, bool limited);

/* Where a ray towards the viewer's side, which meets the mesh at uv, meets the field. */
struct tl_relief {
    vec2s uv;
    float height_m;
};
/* As images are drawn: at most `steps` from cone to cone, from high_m to low_m, then `refine` halvings of the
 * step in which the ray went under, then a straight line. The field must have cones. */
struct tl_relief tl_field_relief(const struct tl_height_field *field, vec2s uv, vec3s view, int steps,
                                 int refine);
/* The truth that it is held against: `steps` of equal height, then halvings to the end. */
struct tl_relief tl_field_march(const struct tl_height_field *field, vec2s uv, vec3s view, int steps);

/* Whether a light is seen from the field at uv, 0 or 1, by `steps` of equal height up to high_m, or as far as
 * DETAIL_REACH. */
float tl_field_lit(const struct tl_height_field *field, vec2s uv, vec3s light, int steps);

/* True where uv lies off a map that does not repeat: the silhouette's clip. */
bool tl_field_is_outside(const struct tl_height_field *field, vec2s uv);

#endif
