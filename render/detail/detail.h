/* The detail maps that a material has and the options need. Pure; threads: any. */
#ifndef TOILE_RENDER_DETAIL_DETAIL_H
#define TOILE_RENDER_DETAIL_DETAIL_H

#include "assets/base/material.h"
#include "render/detail/field.h"
#include "render/detail/options.h"

/* The height field of a part: that of its height map, or else of its weave. */
struct tl_detail_heights {
    tl_image image; /* metres over the mesh, scaled; owned */
    struct tl_height_field field, back;
    float rows[6]; /* from the mesh's UV to repeats of the field, as tl_uv_transform_rows */
};

/* Makes the height field. `uv_metres` is that of the part. False when the material has no heights, or its UV
 * no size. Released by tl_detail_heights_release. */
bool tl_detail_heights_make(const tl_material *material, float uv_metres, float scale,
                            struct tl_detail_heights *out);
void tl_detail_heights_release(struct tl_detail_heights *heights);

/* True if the options need heights, cones, horizons, or moments of normals. */
bool tl_detail_wants_heights(const struct tl_detail_params *params);
bool tl_detail_wants_cones(const struct tl_detail_params *params);
bool tl_detail_wants_horizons(const struct tl_detail_params *params);
bool tl_detail_wants_moments(const struct tl_detail_params *params);
/* True if maps hold slopes in place of normals. */
bool tl_detail_has_offsets(const struct tl_detail_params *params);
/* True if normals follow the derivatives of the surface, which slopes then need not. */
bool tl_detail_has_derivatives(const struct tl_detail_params *params);

/* Number of horizon angles of the full circle. */
int tl_detail_angle_count(const struct tl_detail_params *params);

/* True if the normals are derived from the height map: it has no normal map beside it. */
bool tl_detail_has_own_normals(const tl_material *material);
/* True if drawing the material needs any derived map. */
bool tl_detail_wants_maps(const struct tl_detail_params *params, const tl_material *material);

/* The #defines of detail.glsl for these options; programs must be recompiled when they change. NULL: normal
 * mapping only. */
#define TL_DETAIL_DEFINES_SIZE 192
void tl_detail_defines(const struct tl_detail_params *params, char *out, size_t size);

#endif
