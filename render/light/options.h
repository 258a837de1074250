/* Table "light": how the environment lights and shadows the scene. */
#ifndef TOILE_RENDER_LIGHT_OPTIONS_H
#define TOILE_RENDER_LIGHT_OPTIONS_H

#include "config/options.h"
#include "render/visibility/options.h"

enum tl_method {
    TL_METHOD_PEM,        /* the environment's regions, shadowed one by one */
    TL_METHOD_LIGHTS,     /* the regions as directional lights: no prefiltered maps */
    TL_METHOD_AO,         /* unshadowed light times ambient occlusion */
    TL_METHOD_AO_COLOUR,  /* ... times the occlusion of the diffuse light, by channel */
    TL_METHOD_UNSHADOWED, /* visibility is 1 everywhere */
    TL_METHOD_REFERENCE,  /* ray traced: render/reference */
    TL_METHOD_MAPS        /* classic environment mapping, unshadowed: render/envmap */
};
enum tl_lobe { TL_LOBE_SINGLE, TL_LOBE_DUAL };
enum tl_cut { TL_CUT_FACES, TL_CUT_SPHERE };
enum tl_prefilter { TL_PREFILTER_CHAIN, TL_PREFILTER_SLICES };
/* sum: VIS_i P_i [Knuth et al. 2014, eq. 5]. difference: E - (1 - VIS_i) P_i. ratio: E x sum VIS_i w_i / sum
 * w_i, w_i being P_i or what stands for it. E is the exact unshadowed light. */
/* Places at which the ratio of seen to exact light is computed: for every sample, or at the vertices of the
 * triangles that are seen (render/shade), from where pixels interpolate it. */
enum tl_ratio_at { TL_RATIO_AT_SAMPLES, TL_RATIO_AT_VERTICES };
/* Light that surfaces send on to each other (render/bounce), of rays: none, once, or as often as it likes. */
enum tl_light_bounce { TL_BOUNCE_OFF, TL_BOUNCE_ONE, TL_BOUNCE_ALL };
/* The device that draws frames: the graphics card where GL runs on one, or always one of the two; what the
 * card cannot draw is drawn by the CPU. */
enum tl_light_device { TL_DEVICE_AUTO, TL_DEVICE_CPU, TL_DEVICE_CARD };
enum tl_composition { TL_COMPOSE_SUM, TL_COMPOSE_DIFFERENCE, TL_COMPOSE_RATIO };
struct tl_light_params { /* table "light" */
    int method;          /* enum tl_method */
    int lobe;            /* enum tl_lobe */
    int cut;             /* enum tl_cut */
    int regions;         /* N; cut of the faces: rounded down to a multiple of six */
    bool sun;            /* suns leave the regions and get shadows of their own */
    int prefilter;       /* enum tl_prefilter, of the map back-ends; rays use exact lobes */
    int pem_size;        /* texels per face side, a power of two */
    int filter;          /* enum tl_chain_filter */
    int pems_per_pass;   /* 12 in the paper; 1 to 64 */
    int pem_layout;      /* enum tl_pem_layout (pem/pems.h) */
    int visibility;      /* enum tl_visibility: the back-end */
    int composition;     /* enum tl_composition; rays: ratio only */
    int ratio_at;        /* enum tl_ratio_at, of rays */
    int device;          /* enum tl_light_device, of rays */
    int card_rays;       /* ... there, directions a region */
    bool jitter;         /* maps: directions vary inside their regions from frame to frame; rays: always */
    int rounds;          /* at rest, so many jittered frames are averaged */
    int refresh;         /* rays: regions traced again for each point and moving frame; 0: all */
    int rays;            /* rays: directions a region and refresh */
    float repair;        /* rays: share of the samples, the least certain, that get rays of their own */
    float repair_rest;   /* ... once nothing moves, when it is more */
    int bounce;          /* enum tl_light_bounce, of rays */
    int bounce_shares;   /* ... in motion traced at every N-th of the vertices that are seen */
    int lobes;           /* rays and chains: cosine lobes at most that stand for a gloss of facets */
    bool reflect_scene;  /* near mirrors (s >= TL_MIRROR_EXPONENT) see the lit scene; false: black */
    int map_size;        /* texels, side of a shadow map */
    int moments;         /* enum tl_moments, of variance maps */
    float blur_m; /* metres, like all below by tl_casters_scale: the Gaussian's sigma is blur_m x tan(cone) */
    float depth_bias_m;    /* metres */
    float min_variance;    /* m^2, floor of the VSM variance */
    float bleed_reduction; /* [0, 1): Chebyshev values below it become 0 */
};
extern const struct tl_option_table tl_light_options;
#define TL_MIRROR_EXPONENT 199.0f /* a glossiness of 0.995, however it is rounded */

/* The options of the back-end of rays among these. */
struct tl_ray_params tl_light_ray_params(const struct tl_light_params *light);
/* Whether rounds at rest change the image. */
bool tl_light_averages(const struct tl_light_params *light);

#endif
