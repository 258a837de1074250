/* The G-buffer: for every sample the nearest surface's point, shading normal and material. */
#ifndef TOILE_RENDER_LIGHT_GBUFFER_H
#define TOILE_RENDER_LIGHT_GBUFFER_H

#include "render/detail/detail.h"
#include "render/frame/view.h"
#include "render/surfaces/ground.h"
#include "render/surfaces/surfaces.h"

/* Colours of the target. Half floats hold directions to 0.03 degrees, a fortieth of a PEM's texel. */
enum tl_gbuffer_layer {
    TL_GBUFFER_POINT,    /* RGBA32F: world, metres; coverage */
    TL_GBUFFER_NORMAL,   /* RGBA16F: world, unit, on the viewer's side; 1 - glossiness, of which a half keeps
                            the   third digit where it decides a mirror's exponent */
    TL_GBUFFER_DIFFUSE,  /* RGBA16F: kd with occlusion; octahedral x of the smooth normal */
    TL_GBUFFER_SPECULAR, /* RGBA16F: F ks; octahedral y of the smooth normal */
    TL_GBUFFER_TRIANGLE, /* R32UI: 0 nothing; else 1 + the triangle's number counted through all surfaces, and
                            TL_SAMPLE_BACK where its back is seen */
    TL_GBUFFER_LAYERS
};

struct tl_gbuffer {
    tl_program program; /* for `defines` */
    char defines[TL_DETAIL_DEFINES_SIZE];
    tl_target target;
};

bool tl_gbuffer_create(struct tl_gbuffer *gbuffer, tl_gpu *gpu, tl_error *error);
void tl_gbuffer_release(struct tl_gbuffer *gbuffer);

/* Makes the program anew if these options want another one. */
bool tl_gbuffer_choose_detail(struct tl_gbuffer *gbuffer, tl_gpu *gpu, const struct tl_detail_params *detail,
                              tl_error *error);

/* `ground` is the last of the surfaces, or NULL when none is drawn. Sizes are in samples. */
void tl_gbuffer_draw(struct tl_gbuffer *gbuffer, tl_gpu *gpu, const struct tl_view *view, int width,
                     int height, const tl_surfaces *surfaces, size_t surface_count,
                     const struct tl_ground *ground);

#endif
