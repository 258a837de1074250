/* The G-buffer: for every sample the nearest surface's point, shading normal and material. */
#ifndef TOILE_RENDER_GBUFFER_GBUFFER_H
#define TOILE_RENDER_GBUFFER_GBUFFER_H

#include "render/detail/detail.h"
#include "render/gbuffer/cull.h"
#include "render/scene/view.h"
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
    TL_GBUFFER_WIDENING, /* RGBA16F: added to squared widths of facets along u and v, and to their product.
                            Only where something is faceted: F ks is its F0 then */
    TL_GBUFFER_LAYERS
};

/* Bits of the variants of the program: with the layer of facets; only what lies behind a depth; nothing but
 * the number of the triangle; of a part whose alpha map cuts holes (the other variants decide that while they
 * draw). */
enum {
    TL_GBUFFER_FRAMES = 1,
    TL_GBUFFER_BEHIND = 2,
    TL_GBUFFER_ONLY_TRIANGLE = 4,
    TL_GBUFFER_MASKED = 8,
    TL_GBUFFER_PROGRAMS = 16
};

struct tl_gbuffer {
    char detail[TL_DETAIL_DEFINES_SIZE]; /* that the programs were made for */
    struct tl_gbuffer_program {
        char defines[TL_DETAIL_DEFINES_SIZE + 64];
        tl_program program;
    } programs[TL_GBUFFER_PROGRAMS]; /* made when first used */
    tl_target target;
    struct tl_cull cull; /* of the last draw */
    unsigned kept[2];    /* GL names: its indices, its numbers */
    unsigned numbers;    /* ... and a texture of these */
};

struct tl_gbuffer_request {
    const struct tl_view *view;
    int width, height; /* samples */
    const tl_surfaces *surfaces;
    const tl_surface *const *drawn; /* what they were made of */
    size_t surface_count;
    const struct tl_ground *ground;        /* the last of the surfaces, or NULL when none is drawn */
    const struct tl_detail_params *detail; /* NULL: normals alone */
    bool frames;                           /* with the layer of facets */
    bool blends_lobes; /* one lobe is drawn, between the diffuse and the glossy one (TL_LOBE_SINGLE) */
    bool
        only_triangle; /* one layer, like TL_GBUFFER_TRIANGLE but with places in cull.numbers: an ID buffer */
    const tl_texture *passed; /* only what lies behind this depth; NULL: what is nearest */
};

void tl_gbuffer_release(struct tl_gbuffer *gbuffer);
size_t tl_gbuffer_bytes(const struct tl_gbuffer *gbuffer);
bool tl_gbuffer_reload(struct tl_gbuffer *gbuffer, tl_error *error);
/* Copies the depth of what was drawn, for a request that passes it. */
void tl_gbuffer_keep_depth(const struct tl_gbuffer *gbuffer, tl_gpu *gpu, tl_texture *kept);
bool tl_gbuffer_draw(struct tl_gbuffer *gbuffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                     tl_error *error);

#endif
