/* The light passes: each adds the light of some regions to every sample of the G-buffer [002, eq. 5].
 *
 *     dual:   c = sum VIS_i [ kd P_i(n, 0) + F ks P_i(r, g) ]
 *     single: c = sum VIS_i mix(kd, F ks, g) P_i(mix(n, r, g), g)
 *
 * P_i(d, g) is PEM i looked up in direction d at the level that stands for g. The sum is kept in RGBA32F. */
#ifndef TOILE_RENDER_LIGHT_LIGHT_H
#define TOILE_RENDER_LIGHT_LIGHT_H

#include "render/light/gbuffer.h"
#include "render/pem/lobe.h"
#include "render/pem/pems.h"
#include "render/visibility/maps.h"

#define TL_PASS_REGIONS_MAX 64 /* of light.frag */

struct tl_lighting {
    tl_program program;
    unsigned regions_buffer; /* GL name: TL_PASS_REGIONS_MAX x struct tl_region_view */
    tl_texture lobe_levels;  /* chain level by glossiness */
    tl_target target;        /* premultiplied by coverage; shares the G-buffer's depth */
};

struct tl_light_request {
    const struct tl_gbuffer *gbuffer;
    const struct tl_pems *pems;
    const struct tl_regions *regions;
    const tl_shadow_maps *maps;
    struct tl_casters casters;
    const struct tl_ground *ground; /* NULL: none */
    float environment_yaw;          /* rad */
    vec3s eye;
    const struct tl_light_params *params;
};

bool tl_lighting_create(struct tl_lighting *lighting, tl_gpu *gpu, tl_error *error);
void tl_lighting_release(struct tl_lighting *lighting);

void tl_lighting_set_lobe(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_lobe_table *table);
/* The light of every sample, as tl_compose writes it, in place of the passes. */
void tl_lighting_set(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_gbuffer *gbuffer,
                     const float *light);
void tl_lighting_draw(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_light_request *request);

#endif
