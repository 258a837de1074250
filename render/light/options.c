#include "render/brdf/fan.h"
#include "render/pem/chain.h"
#include "render/pem/regions.h"
#include "render/renderer.h"

static const char *const method_names[] = {"pem",        "lights",    "ao", "ao_colour",
                                           "unshadowed", "reference", NULL};
static const char *const lobe_names[] = {"single", "dual", NULL};
static const char *const cut_names[] = {"faces", "sphere", NULL};
static const char *const prefilter_names[] = {"chain", "slices", NULL};
static const char *const visibility_names[] = {"vsm", "depth", "rays", NULL};
static const char *const composition_names[] = {"sum", "difference", "ratio", NULL};

typedef struct tl_light_params light_params;
static const struct tl_option light_rows[] = {
    TL_OPTION_ENUM(
        light_params, method, method_names,
        "pem: light of each region times its visibility; lights: regions as directional lights; ao, "
        "ao_colour: ambient occlusion; unshadowed: visibility is 1; reference: ray traced"),
    TL_OPTION_ENUM(light_params, lobe, lobe_names,
                   "single: one look-up from diffuse to mirror by glossiness; dual: diffuse plus gloss"),
    TL_OPTION_ENUM(light_params, cut, cut_names,
                   "faces: median cut of each cube face; sphere: cut of the whole sphere by variance"),
    TL_OPTION_INT(light_params, regions, 6, TL_REGIONS_MAX, "",
                  "regions of the environment, in sixes; more give truer shadows for more time and memory"),
    TL_OPTION_BOOL(light_params, sun, "suns leave the regions and get shadows of their own"),
    TL_OPTION_ENUM(light_params, prefilter, prefilter_names,
                   "chain: the 2014 filter chain; slices: exact lobes; rays always use exact lobes"),
    TL_OPTION_INT(
        light_params, pem_size, 4, 512, "texels",
        "side of a PEM's cube face, a power of two; larger sharpens mirrors for four times the memory"),
    TL_OPTION_ENUM(light_params, filter, tl_chain_filter_names,
                   "filter between the levels of a PEM; wider ones make glossy highlights rounder"),
    TL_OPTION_INT(light_params, pems_per_pass, 1, 64, "",
                  "regions added up in one drawing pass; more need fewer passes and larger textures"),
    TL_OPTION_ENUM(light_params, visibility, visibility_names,
                   "vsm: variance shadow maps; depth: plain shadow maps; rays: rays kept at vertices"),
    TL_OPTION_ENUM(
        light_params, composition, composition_names,
        "sum: of shadowed light; difference: exact light less what is shadowed; ratio: exact light "
        "times the share that is seen (rays: always)"),
    TL_OPTION_BOOL(light_params, jitter, "directions vary inside their regions from frame to frame"),
    TL_OPTION_INT(light_params, rounds, 1, 4096, "frames",
                  "jittered frames averaged while nothing moves; more make still images truer"),
    TL_OPTION_INT(light_params, refresh, 0, TL_REGIONS_MAX, "regions",
                  "rays: regions traced anew for each point and moving frame, twice as many at rest; 0: all"),
    TL_OPTION_INT(light_params, rays, 1, 64, "",
                  "rays: directions traced a region; more are truer and slower"),
    TL_OPTION_FLOAT(light_params, repair, 0, 1, "",
                    "rays: share of the samples, the least certain ones, that get rays of their own"),
    TL_OPTION_FLOAT(light_params, repair_rest, 0, 1, "",
                    "rays: the same once nothing moves, when it is more: spread over frames at rest"),
    TL_OPTION_INT(
        light_params, fan, 1, TL_FAN_MAX, "",
        "rays: cosine lobes at most for a gloss that is not one itself; more follow it closer, slower"),
    TL_OPTION_BOOL(light_params, reflect_scene,
                   "near mirrors (exponent 200 and more) show the lit scene; off: black"),
    TL_OPTION_INT(light_params, map_size, 1, 4096, "texels",
                  "side of a shadow map; larger keeps small shadows for more time and memory"),
    TL_OPTION_FLOAT(light_params, blur_m, 0, 10, "m",
                    "shadow blur: sigma is this times the tangent of a region's cone; larger is softer"),
    TL_OPTION_FLOAT(light_params, depth_bias_m, 0, 1, "m",
                    "depth that a shadow must differ by; larger hides false shadows and loses small ones"),
    TL_OPTION_FLOAT(
        light_params, min_variance, 0, 1, "m^2",
        "least variance of depth in a shadow map; larger hides false shadows and leaks more light"),
    TL_OPTION_FLOAT(light_params, bleed_reduction, 0, 0.95, "",
                    "visibility below it becomes 0; larger leaks less light and hardens soft shadows"),
};
const struct tl_option_table tl_light_options = TL_OPTION_TABLE(
    "light", "how the environment lights and shadows the scene", light_rows, light_params,
    .method = TL_METHOD_PEM, .lobe = TL_LOBE_DUAL, .regions = 96, .pem_size = 128,
    .filter = TL_CHAIN_SQRT_COSINE, .pems_per_pass = 12, .rounds = 1, .rays = 1, .fan = 5, .map_size = 256,
    .blur_m = 0.05f, .depth_bias_m = 0.004f, .min_variance = 1e-6f, .bleed_reduction = 0.1f);

static const char *const model_names[] = {"phong", "blinn_phong", "cosine_lobe", "torrance_sparrow",
                                          "ward",  "banks",       NULL};
static const char *const facets_names[] = {"gaussian", "beckmann", NULL};
static const char *const masking_names[] = {"smith", "v_grooves", NULL};
static const char *const fresnel_names[] = {"schlick", "dielectric", "conductor", NULL};

typedef struct tl_material_params material_params;
static const struct tl_option material_rows[] = {
    TL_OPTION_BOOL(material_params, use_file, "keep the materials of the garment's file where it has them"),
    TL_OPTION_COLOUR(material_params, diffuse, 0, 1, "share of light scattered evenly; larger is brighter"),
    TL_OPTION_COLOUR(material_params, specular, 0, 1,
                     "share of light reflected at normal incidence; 0.04 for most fibres, larger is shinier"),
    TL_OPTION_FLOAT(
        material_params, glossiness, 0, 1, "",
        "0 reflects in all directions, 1 is a mirror; the lobe's exponent is 1 / (1 - glossiness)"),
    TL_OPTION_ENUM(material_params, model, model_names, "how gloss is spread about the mirror direction"),
    TL_OPTION_ENUM(material_params, facets, facets_names,
                   "torrance_sparrow: how the slopes of its facets are spread"),
    TL_OPTION_ENUM(material_params, masking, masking_names, "torrance_sparrow: how facets hide one another"),
    TL_OPTION_ENUM(material_params, fresnel, fresnel_names,
                   "how reflectance rises towards grazing angles: from specular, or from the index"),
    TL_OPTION_FLOAT(material_params, index, 1, 200, "",
                    "index of refraction of dielectric and conductor; larger reflects more"),
    TL_OPTION_FLOAT(material_params, extinction, 0, 20, "", "conductor: imaginary part of the index"),
    TL_OPTION_FLOAT(material_params, width_weft, 0, 1, "",
                    "torrance_sparrow, ward: root mean square slope of the facets along the weft; larger is "
                    "duller; 0: from glossiness"),
    TL_OPTION_FLOAT(material_params, width_warp, 0, 1, "", "ward: ... along the warp"),
    TL_OPTION_FLOAT(material_params, rotation_deg, -360, 360, "degrees",
                    "ward, banks: turns weft and warp, counter-clockwise seen from outside"),
    TL_OPTION_FLOAT(material_params, coat, 0, 1, "", "share of the surface under a clear coat of index 1.5"),
    TL_OPTION_FLOAT(material_params, coat_glossiness, 0, 1, "", "glossiness of the coat"),
    TL_OPTION_COLOUR(material_params, transmission, 0, 1,
                     "share of light scattered through to the other side; larger is more sheer"),
    TL_OPTION_FLOAT(
        material_params, openness, 0, 0.99, "",
        "share of the surface that is holes between threads; larger shows more of what is behind"),
};
const struct tl_option_table tl_material_options = TL_OPTION_TABLE(
    "material", "the garment's look: two lobes, diffuse and glossy", material_rows, material_params,
    .use_file = true, .diffuse = {0.5f, 0.5f, 0.5f}, .specular = {0.04f, 0.04f, 0.04f}, .glossiness = 0.5f,
    .index = 1.5f, .coat_glossiness = 0.95f);
