/* Local lighting: the light of lamps, added to the light target by drawing the surfaces again over the
 * G-buffer's depth, one lamp and one part of a surface at a time, with a program for each way of shading.
 *
 *     c += cover E(x) V(x) s(n0.l) [ kd/pi max(0, n.l) + f_r(l, v) n.l ]
 *
 * with the gloss f_r cos of render/brdf/brdf.h, n0 the normal without bumps and s the self-shadow, under the
 * material's coat and as far as it is no hole. What is seen behind open cloth, through cloth and in mirrors
 * gets its lamplight by lamp_samples.h. Lamps know
 * the material's two lobes; light.lobe is about the environment. Everything is made when it is first used,
 * and nothing without lamps. */
#ifndef TOILE_RENDER_LOCAL_LOCAL_H
#define TOILE_RENDER_LOCAL_LOCAL_H

#include "render/gbuffer/gbuffer.h"
#include "render/local/lamp.h"
#include "render/local/lamp_shadows.h"
#include "render/local/shading.h"
#include "render/local/table_textures.h"

#define TL_LOCAL_DEFINES_SIZE 1024

struct tl_local_program {
    char defines[TL_LOCAL_DEFINES_SIZE];
    tl_program program;
};

struct tl_local {
    size_t program_count;
    struct tl_local_program **programs; /* apart, because a program's defines must stay where they are */
    struct tl_lamp_shadows shadows;
    struct tl_table_textures tables;
    tl_target product; /* what passes multiply in; shares the G-buffer's depth */
    bool product_used; /* in this frame */
};

struct tl_local_request {
    const struct tl_gbuffer *gbuffer;
    const tl_target *light; /* has the G-buffer's depth */
    const struct tl_view *view;
    const tl_surfaces *surfaces;
    size_t surface_count;
    const struct tl_ground *ground; /* NULL: none; else the last of the surfaces */
    struct tl_casters casters;
    const struct tl_lamp *lamps;
    size_t lamp_count;
    const struct tl_shading_params *params;
    const struct tl_detail_params *detail; /* as the G-buffer has it; NULL: its defaults */
    float depth_bias_m;                    /* of shadow maps */
    float weight;                          /* of this image among those that are averaged in the target */
};

void tl_local_release(struct tl_local *local);
void tl_local_reload(struct tl_local *local);        /* programs are made again from their files */
size_t tl_local_bytes(const struct tl_local *local); /* of tables and the passes' target, without shadows */
bool tl_local_draw(struct tl_local *local, tl_gpu *gpu, const struct tl_local_request *request,
                   tl_error *error);

#endif
