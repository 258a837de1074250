/* The light passes: the light of every sample of the G-buffer from the regions' light and their shadow maps.
 *
 *     dual:   c = sum VIS_i [ kd P_i(n, 1) + F ks P_i(r, s) ]
 *     single: c = sum VIS_i mix(kd, F ks, g) P_i(mix(n, r, g), s) [Knuth et al. 2014, eq. 5]
 *
 * chain.frag adds up P_i of the filter chains, some regions a pass, as the paper does. regions.frag takes all
 * regions at once: P_i from exact slices, or what stands for it, the region's power times a cosine lobe
 * broadened by its spread; and puts them together as light.composition states. Light is kept in RGBA32F,
 * where the rounds of a frame that rests are averaged. */
#ifndef TOILE_RENDER_LIGHT_LIGHT_H
#define TOILE_RENDER_LIGHT_LIGHT_H

#include "render/env/lobes.h"
#include "render/env/sun.h"
#include "render/gbuffer/gbuffer.h"
#include "render/light/light_buffer.h"
#include "render/light/lobe_sums.h"
#include "render/light/options.h"
#include "render/pem/lobe.h"
#include "render/pem/pems.h"
#include "render/pem/slice_maps.h"
#include "render/visibility/maps.h"

/* The source of the regions' light. */
enum tl_light_source { TL_LIGHT_CHAIN, TL_LIGHT_SLICES, TL_LIGHT_LOBES, TL_LIGHT_EXACT, TL_LIGHT_SOURCES };

/* The light source that these settings select. The ratio of filter chains would need all of them in one pass;
 * its weights need not be exact, and the broadened lobes replace them. */
enum tl_light_source tl_light_source(const struct tl_light_params *params);
/* Whether the exact light of the whole environment is read (env/lobes.h). */
bool tl_light_needs_exact(const struct tl_light_params *params);
/* Whether gloss of facets is drawn as a sum of lobes by passes: those that look nothing but PEMs up. */
bool tl_light_sums_lobes(const struct tl_light_params *params);
/* Whether the light of every sample is composed on the CPU, which draws all lobes of a material; what draws
 * with GL has two. */
bool tl_light_is_composed(const struct tl_light_params *params);

/* Programs: one a source, and for chains others that are paraboloid maps, sums of lobes, or both. */
#define TL_LIGHT_PROGRAMS  (TL_LIGHT_SOURCES + 3)
#define TL_LIGHT_MAP_KINDS 3 /* enum tl_visibility, none instead of rays */

/* GL programs that draw light, and the table of exponents that they look up. A cache: affects speed, never
 * the image. */
struct tl_lighting {
    tl_program programs[TL_LIGHT_PROGRAMS][TL_LIGHT_MAP_KINDS]; /* made when first used */
    unsigned regions_buffer;                                    /* GL name: regions, then suns */
    tl_texture exponent_levels; /* fractional number of an exponent by the logarithm of s */
    /* One texel, for samplers that compare where there are no maps: what else they read is undefined. */
    tl_texture no_depths;
    /* The exact light of the whole environment on the GPU, for passes that read it. */
    struct tl_exact_maps {
        tl_texture lobes;                       /* maps of the lobes, stacked */
        float places[TL_EXPONENT_COUNT + 1][2]; /* first row and side of each */
        uint32_t sent;                          /* exponents that are there, of the cube of this revision: */
        uint64_t revision;
    } exact;
};

/* The chain level by glossiness, as a texture: made at the first call. */
void tl_lobe_levels_upload(tl_texture *levels, tl_gpu *gpu, const struct tl_lobe_table *table);

struct tl_light_request {
    const struct tl_gbuffer *gbuffer;
    const struct tl_pems *pems;         /* of CHAIN */
    const tl_texture *lobe_levels;      /* ... */
    const struct tl_lobes *exact;       /* where tl_light_needs_exact */
    uint64_t exact_revision;            /* ... of their cube */
    const struct tl_slice_maps *slices; /* of SLICES */
    const struct tl_lobe_sums *sums;    /* where gloss of facets is drawn so; or NULL */
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
/* The light of every sample. */
bool tl_lighting_draw(struct tl_lighting *lighting, tl_gpu *gpu, const struct tl_light_request *request,
                      struct tl_light_buffer *out, tl_error *error);

#endif
