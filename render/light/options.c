#include "render/light/options.h"

#include "render/brdf/lobe_fit.h"
#include "render/pem/chain.h"
#include "render/pem/regions.h"
#include "render/plan/affects.h"

static const char *const method_names[] = {"pem",        "lights",    "ao",   "ao_colour",
                                           "unshadowed", "reference", "maps", NULL};
static const char *const lobe_names[] = {"single", "dual", NULL};
static const char *const cut_names[] = {"faces", "sphere", NULL};
static const char *const prefilter_names[] = {"chain", "slices", NULL};
static const char *const pem_layout_names[] = {"cube", "paraboloid", NULL};
static const char *const visibility_names[] = {"vsm", "depth", "rays", "auto", NULL};
static const char *const moments_names[] = {"float", "half", NULL};
static const char *const ratio_at_names[] = {"samples", "vertices", NULL};
static const char *const device_names[] = {"auto", "cpu", "card", NULL};
static const char *const bounce_names[] = {"off", "one", "all", NULL};
static const char *const composition_names[] = {"sum", "difference", "ratio", NULL};

typedef struct tl_light_params light_params;
static const struct tl_option light_rows[] = {
    TL_OPTION_ENUM(light_params, method, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LIGHT, method_names,
                   "pem: light of each region times its visibility; lights: regions as directional lights; "
                   "ao, ao_colour: ambient occlusion; unshadowed: visibility is 1; reference: ray traced; "
                   "maps: environment maps (table maps), unshadowed"),
    TL_OPTION_ENUM(
        light_params, lobe, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LIGHT, lobe_names,
        "single: one look-up, from diffuse to mirror by glossiness; dual: a diffuse and a glossy look-up"),
    TL_OPTION_ENUM(light_params, cut, TL_AFFECTS_APPEARANCE | TL_AFFECTS_REGIONS, cut_names,
                   "faces: median cut of each cube face; sphere: cut of the whole sphere by variance"),
    TL_OPTION_INT(light_params, regions, TL_AFFECTS_APPEARANCE | TL_AFFECTS_REGIONS, 6, TL_REGIONS_MAX, "",
                  "number of regions of the environment, a multiple of six; larger: truer shadows, more time "
                  "and memory"),
    TL_OPTION_BOOL(light_params, sun, TL_AFFECTS_APPEARANCE | TL_AFFECTS_SUN,
                   "small bright sources (suns) are taken out of the regions and cast shadows of their own"),
    TL_OPTION_ENUM(light_params, prefilter, TL_AFFECTS_APPEARANCE | TL_AFFECTS_FILTER | TL_AFFECTS_LIGHT,
                   prefilter_names,
                   "chain: the 2014 filter chain; slices: exact lobes; rays always use exact lobes"),
    TL_OPTION_INT(
        light_params, pem_size, TL_AFFECTS_APPEARANCE | TL_AFFECTS_PEM_SIZE, 4, 512, "texels",
        "side of a PEM's cube face, a power of two; twice as large: sharper mirrors, four times the memory"),
    TL_OPTION_ENUM(light_params, filter, TL_AFFECTS_APPEARANCE | TL_AFFECTS_FILTER, tl_chain_filter_names,
                   "filter between the levels of a PEM; wider filters make glossy highlights rounder"),
    TL_OPTION_INT(light_params, pems_per_pass, TL_AFFECTS_APPEARANCE | TL_AFFECTS_PASSES, 1, 64, "",
                  "regions summed in one drawing pass; larger: fewer passes, larger textures"),
    TL_OPTION_ENUM(light_params, pem_layout, TL_AFFECTS_APPEARANCE | TL_AFFECTS_PASSES, pem_layout_names,
                   "cube: a PEM is a cube map; paraboloid: parts of paraboloid maps, cropped to where it is "
                   "not black: a thirteenth of the memory at 96 regions, slightly softer, a third slower"),
    TL_OPTION_ENUM(
        light_params, visibility, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LIGHT | TL_AFFECTS_SHADOW_MAPS,
        visibility_names,
        "vsm: variance shadow maps; depth: plain shadow maps; rays: rays cached at vertices; auto: rays, "
        "or vsm where a few frames at start show that rays cannot hold the budget and maps can"),
    TL_OPTION_ENUM(light_params, composition, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LIGHT, composition_names,
                   "sum: shadowed light of all regions; difference: exact light minus the occluded light; "
                   "ratio: exact light times its visible fraction (rays: always)"),
    TL_OPTION_ENUM(light_params, ratio_at, TL_AFFECTS_APPEARANCE | TL_AFFECTS_RATIO, ratio_at_names,
                   "rays: where the ratio of visible to exact light is computed: samples: at every sample; "
                   "vertices: at vertices, interpolated: several times faster, slightly softer"),
    TL_OPTION_ENUM(light_params, device, TL_AFFECTS_APPEARANCE | TL_AFFECTS_RATIO, device_names,
                   "rays: cpu: drawn by the CPU's cores; card: by compute shaders of OpenGL, where they can "
                   "(toile plan): "
                   "at vertices in motion, and at rest by rounds of paths; auto: by these where OpenGL runs "
                   "on a graphics card"),
    TL_OPTION_INT(light_params, card_rays, TL_AFFECTS_APPEARANCE | TL_AFFECTS_RAYS, 1, 8, "",
                  "rays on a graphics card: directions traced per region; larger: more exact, slower"),
    TL_OPTION_BOOL(light_params, jitter, TL_AFFECTS_APPEARANCE | TL_AFFECTS_SHADOW_MAPS | TL_AFFECTS_RAYS,
                   "maps: directions vary within their regions from frame to frame (rays: always)"),
    TL_OPTION_INT(light_params, rounds, TL_AFFECTS_APPEARANCE, 1, 4096, "frames",
                  "jittered frames averaged while nothing moves; on a graphics card sixteen times as many; "
                  "larger: more "
                  "exact still images"),
    TL_OPTION_INT(light_params, refresh, TL_AFFECTS_APPEARANCE | TL_AFFECTS_RAYS, 0, TL_REGIONS_MAX,
                  "regions",
                  "regions renewed per frame in motion; 0: all. rays: traced for each point, twice as many "
                  "at rest; maps: redrawn in order of energy and age, all at rest"),
    TL_OPTION_INT(light_params, rays, TL_AFFECTS_APPEARANCE | TL_AFFECTS_RAYS, 1, 64, "",
                  "rays: directions traced per region; larger: more exact, slower"),
    TL_OPTION_FLOAT(light_params, repair, TL_AFFECTS_APPEARANCE | TL_AFFECTS_RAYS, 0, 1, "",
                    "rays: fraction of the samples, the least certain ones, that trace rays of their own"),
    TL_OPTION_FLOAT(light_params, repair_rest, TL_AFFECTS_APPEARANCE | TL_AFFECTS_RAYS, 0, 1, "",
                    "rays: the same fraction at rest, if it is larger; spread over several frames"),
    TL_OPTION_ENUM(
        light_params, bounce, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LIGHT, bounce_names,
        "rays: light that surfaces send on to each other: off: none; one: light that comes straight "
        "from the environment; all: light that bounced before, too"),
    TL_OPTION_INT(light_params, bounce_shares, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LIGHT, 1, 256, "",
                  "bounced light is renewed at every N-th of the vertices that are seen in each frame of "
                  "motion, at a fourth of that elsewhere; larger: faster, it lags"),
    TL_OPTION_INT(light_params, lobes, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LIGHT, 1, TL_LOBE_FIT_MAX, "",
                  "rays and filter chains: maximum number of cosine lobes that approximate gloss of another "
                  "shape; larger: more exact, slower"),
    TL_OPTION_BOOL(
        light_params, reflect_scene, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LIGHT,
        "mirrors (exponent 200 and more) reflect nearby lit surfaces; off: these reflect as black"),
    TL_OPTION_INT(light_params, map_size, TL_AFFECTS_APPEARANCE | TL_AFFECTS_SHADOW_MAPS, 8, 4096, "texels",
                  "side of a shadow map; larger: smaller shadows appear, more time and memory"),
    TL_OPTION_ENUM(light_params, moments, TL_AFFECTS_APPEARANCE | TL_AFFECTS_SHADOW_MAPS, moments_names,
                   "vsm: precision of depth's moments; half: half the memory, but light leaks within "
                   "centimetres of what shadows"),
    TL_OPTION_FLOAT(light_params, blur_m, TL_AFFECTS_APPEARANCE | TL_AFFECTS_SHADOW_MAPS, 0, 10, "m",
                    "shadow blur: sigma is this times the tangent of a region's cone angle; larger: softer. "
                    "Of scenes less than 1 m across less, in proportion"),
    TL_OPTION_FLOAT(light_params, depth_bias_m, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LIGHT, 0, 1, "m",
                    "minimum depth difference of a shadow; larger: fewer false shadows, but small ones are "
                    "lost. Of scenes less than 1 m across less, in proportion"),
    TL_OPTION_FLOAT(
        light_params, min_variance, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LIGHT, 0, 1, "m^2",
        "minimum variance of depth in a shadow map; larger: fewer false shadows, more light leaks"),
    TL_OPTION_FLOAT(light_params, bleed_reduction, TL_AFFECTS_APPEARANCE | TL_AFFECTS_LIGHT, 0, 0.95, "",
                    "visibility below this becomes 0; larger: fewer light leaks, harder shadows"),
};
const struct tl_option_table tl_light_options = TL_OPTION_TABLE(
    "light", "light and shadows of the environment", light_rows, light_params, .method = TL_METHOD_PEM,
    .lobe = TL_LOBE_DUAL, .regions = 96, .pem_size = 128, .filter = TL_CHAIN_SQRT_COSINE, .pems_per_pass = 12,
    .rounds = 1, .rays = 1, .card_rays = 4, .bounce_shares = 8, .lobes = 5, .map_size = 256, .blur_m = 0.05f,
    .depth_bias_m = 0.004f, .min_variance = 1e-6f, .bleed_reduction = 0.1f);

struct tl_ray_params tl_light_ray_params(const struct tl_light_params *light)
{
    return (struct tl_ray_params){.rays = light->rays,
                                  .refresh = light->refresh,
                                  .rounds = light->rounds,
                                  .repair = light->repair,
                                  .repair_rest = light->repair_rest,
                                  .weighs_solid_angle = light->method == TL_METHOD_AO};
}

bool tl_light_averages(const struct tl_light_params *light)
{
    return (light->jitter || light->visibility == TL_VISIBILITY_RAYS) &&
           light->method != TL_METHOD_REFERENCE && light->method != TL_METHOD_UNSHADOWED &&
           light->method != TL_METHOD_MAPS;
}
