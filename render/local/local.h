/* Local lighting: the light of lamps, added to the light target by drawing the surfaces again over the depth
 * of the G-buffer, one lamp and one part of a surface at a time, with a program for each combination of
 * shading options.
 *
 *     c += cover E(x) V(x) s(n0.l) [ kd/pi max(0, n.l) + f_r(l, v) n.l ]
 *
 * with the gloss f_r cos of render/brdf/brdf.h, the normal n0 without bumps and the self-shadow s; below the
 * coat of the material, and multiplied by 1 - openness. To that comes E ambient kd/pi, which nothing shadows
 * (tl_shading_params). What a material emits is added alike, once:
 * c += cover (1 - openness) (1 - coat) emission. lamp_samples.h adds the light of lamps behind open
 * cloth, through cloth and in mirrors. Lamps always use two lobes; light.lobe applies to the environment.
 * Resources are made when they are first used, and none without lamps. Needs the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_LOCAL_LOCAL_H
#define TOILE_RENDER_LOCAL_LOCAL_H

#include "render/gbuffer/gbuffer.h"
#include "render/local/lamp.h"
#include "render/local/lamp_shadows.h"
#include "render/local/lit_texture.h"
#include "render/local/object_map.h"
#include "render/local/shading.h"
#include "render/local/table_textures.h"

#define TL_LOCAL_DEFINES_SIZE 1024

struct tl_local_program {
    char defines[TL_LOCAL_DEFINES_SIZE];
    tl_program program;
};

struct tl_local {
    size_t program_count;
    struct tl_local_program **programs; /* by pointer, so that the defines of a program do not move */
    struct tl_lamp_shadows shadows;
    struct tl_table_textures tables;
    tl_target product;             /* target in which passes multiply; shares the depth of the G-buffer */
    bool product_used;             /* in this frame */
    bool has_reported;             /* a material that refuses shading.table_terms */
    struct tl_lit_texture lit;     /* of TL_SPACE_TEXTURE */
    bool lit_used;                 /* in this frame */
    struct tl_object_maps normals; /* of TL_SPACE_OBJECT */
};

struct tl_local_request {
    const struct tl_gbuffer *gbuffer;
    const tl_target *light; /* with the depth of the G-buffer */
    const struct tl_view *view;
    const tl_surfaces *surfaces;
    const tl_surface *const *drawn; /* what they were made of; NULL: no textures over UVs */
    size_t surface_count;
    const struct tl_ground *ground; /* NULL: none; else the last of the surfaces */
    struct tl_casters casters;
    const struct tl_lamp *lamps;
    size_t lamp_count; /* 0: only what surfaces emit is added */
    const struct tl_shading_params *params;
    const struct tl_detail_params *detail; /* as in the G-buffer; NULL: defaults */
    float depth_bias_m;                    /* of shadow maps */
    float weight;                          /* weight of this image in the average of the target */
};

/* Frees and zeroes. */
void tl_local_release(struct tl_local *local);
/* Discards all programs, so that they are compiled again from their files. */
void tl_local_reload(struct tl_local *local);
/* Size of the tables, of the target of the passes and of the texture that is lit, without shadows. */
size_t tl_local_bytes(const struct tl_local *local);
/* Adds the light of all lamps, and what surfaces emit. False when a shader cannot be compiled. */
bool tl_local_draw(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                   tl_error *error);

#endif
