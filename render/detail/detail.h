/* What a material has of detail, and what of it the options ask for. Pure; threads: any. */
#ifndef TOILE_RENDER_DETAIL_DETAIL_H
#define TOILE_RENDER_DETAIL_DETAIL_H

#include "assets/base/material.h"
#include "render/detail/field.h"
#include "render/detail/options.h"

/* A part's height field: of its height map, or else of its weave. */
struct tl_detail_heights {
    tl_image image; /* metres over the mesh, scaled; owned */
    struct tl_height_field field, back;
    float rows[6]; /* from the mesh's UV to repeats of the field, as tl_uv_transform_rows */
};

/* False when the material has no heights, or its UV no size: `uv_metres` is the part's. */
bool tl_detail_heights_make(const tl_material *material, float uv_metres, float scale,
                            struct tl_detail_heights *out);
void tl_detail_heights_release(struct tl_detail_heights *heights);

/* Whether heights are read while drawing; cones of relief; horizons; moments of normals. */
bool tl_detail_wants_heights(const struct tl_detail_params *params);
bool tl_detail_wants_cones(const struct tl_detail_params *params);
bool tl_detail_wants_horizons(const struct tl_detail_params *params);
bool tl_detail_wants_moments(const struct tl_detail_params *params);

/* Of horizons, all around. */
int tl_detail_angle_count(const struct tl_detail_params *params);

/* A height map without a normal map bends the light by its own slopes, in every mode. */
bool tl_detail_has_own_normals(const tl_material *material);
/* Whether drawing this material needs any map that is derived from its own. */
bool tl_detail_wants_maps(const struct tl_detail_params *params, const tl_material *material);

/* The lines that choose what detail.glsl does; a program must be made anew when they change. NULL: normals
 * alone. */
#define TL_DETAIL_DEFINES_SIZE 192
void tl_detail_defines(const struct tl_detail_params *params, char *out, size_t size);

#endif
