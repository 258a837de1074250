/* The light passes: the light of every sample of the G-buffer from the regions' light and their shadow maps.
 *
 *     dual:   c = sum VIS_i [ kd P_i(n, 1) + F ks P_i(r, s) ]
 *     single: c = sum VIS_i mix(kd, F ks, g) P_i(mix(n, r, g), s) [002, eq. 5]
 *
 * chain.frag adds up P_i of the filter chains, some regions a pass, as the paper does. regions.frag takes all
 * regions at once: P_i from exact slices, or what stands for it, the region's power times a cosine lobe
 * broadened by its spread; and puts them together as light.composition says. Light is kept in RGBA32F, where
 * the rounds of a frame that rests are averaged. */
#ifndef TOILE_RENDER_LIGHT_LIGHT_H
#define TOILE_RENDER_LIGHT_LIGHT_H

#include "render/env/lobes.h"
#include "render/env/sun.h"
#include "render/gbuffer/gbuffer.h"
#include "render/light/options.h"
#include "render/pem/lobe.h"
#include "render/pem/pems.h"
#include "render/pem/slice_maps.h"
#include "render/visibility/maps.h"

/* Where the regions' light comes from. */
enum tl_light_source { TL_LIGHT_CHAIN, TL_LIGHT_SLICES, TL_LIGHT_LOBES, TL_LIGHT_EXACT, TL_LIGHT_SOURCES };

/* What these settings ask for. The ratio of chains would need all of them in one pass, and its weights need
 * not be exact: there the broadened lobes stand for them. */
enum tl_light_source tl_light_source(const struct tl_light_params *params);
/* Whether the exact light of the whole environment is read (env/lobes.h). */
bool tl_light_needs_exact(const struct tl_light_params *params);

#define TL_LIGHT_MAP_KINDS 3 /* enum tl_visibility, none instead of rays */

struct tl_lighting {
    tl_program programs[TL_LIGHT_SOURCES][TL_LIGHT_MAP_KINDS]; /* made when first used */
    unsigned regions_buffer;                                   /* GL name: regions, then suns */
    tl_texture lobe_levels;                                    /* chain level by glossiness */
    tl_texture exponent_levels;                  /* fractional number of an exponent by the logarithm of s */
    tl_texture lobes;                            /* maps of the exact light, stacked */
    float lobe_places[TL_EXPONENT_COUNT + 1][2]; /* first row and side of each */
    tl_target target;                            /* premultiplied by coverage; shares the G-buffer's depth */
};

struct tl_light_request {
    const struct tl_gbuffer *gbuffer;
    const struct tl_pems *pems;         /* of CHAIN */
    const struct tl_slice_maps *slices; /* of SLICES */
    const struct tl_regions *regions;
    const struct tl_suns *suns;
    const tl_shadow_maps *maps; /* drawn, unless the method is UNSHADOWED */
    struct tl_casters casters;
    const struct tl_ground *ground; /* NULL: none */
    float environment_yaw;          /* rad */
    vec3s eye;
    int round; /* this many images are in the target, and this one is averaged in; 0: it replaces them */
    const struct tl_light_params *params;
};

bool tl_lighting_create(struct tl_lighting *lighting, tl_gpu *gpu, tl_error *error);
void tl_lighting_release(struct tl_lighting *lighting);
bool tl_lighting_reload(struct tl_lighting *lighting, tl_error *error);
size_t tl_lighting_bytes(const struct tl_lighting *lighting); /* of textures, without the target */

void tl_lighting_set_lobe(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_lobe_table *table);
void tl_lighting_set_exact(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_lobes *lobes);
/* Makes the target as large as the G-buffer and binds it, with the G-buffer's layers in the first units, so
 * that what is drawn over it (at depth 1) keeps to the samples that are covered. The others are black, if
 * this image is begun afresh. */
void tl_lighting_begin(struct tl_lighting *lighting, tl_gpu *gpu, const tl_target *gbuffer, bool afresh);
/* The light of every sample, as tl_compose writes it, in place of the passes. */
void tl_lighting_set(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_gbuffer *gbuffer,
                     const float *light);
bool tl_lighting_draw(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_light_request *request,
                      tl_error *error);

#endif
