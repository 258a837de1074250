#include "render/brdf/options.h"

static const char *const model_names[] = {"phong", "blinn_phong", "cosine_lobe", "torrance_sparrow",
                                          "ward",  "banks",       NULL};
static const char *const facets_names[] = {"gaussian", "beckmann", "ggx", NULL};
static const char *const masking_names[] = {"smith", "v_grooves", "schlick", NULL};
static const char *const ward_names[] = {"published", "bounded", NULL};
static const char *const on_print_names[] = {"replace", "tint", "keep", NULL};
static const char *const fresnel_names[] = {"schlick", "dielectric", "conductor", NULL};

#define AFFECTS (TL_AFFECTS_MATERIALS | TL_AFFECTS_APPEARANCE | TL_AFFECTS_AT_ONCE)

typedef struct tl_material_params material_params;
static const struct tl_option material_rows[] = {
    TL_OPTION_BOOL(material_params, use_file, AFFECTS,
                   "keep the materials of the garment's file, if it has any"),
    TL_OPTION_COLOUR(material_params, diffuse, AFFECTS, 0, 1, "diffuse albedo; larger: brighter"),
    TL_OPTION_FLOAT(material_params, diffuse_roughness, AFFECTS, 0, 1, "rad",
                    "spread of the facets that reflect diffusely; larger: flatter, as felt and chalk are; "
                    "0: Lambert's law"),
    TL_OPTION_COLOUR(material_params, specular, AFFECTS, 0, 1,
                     "reflectance at normal incidence; 0.04 for most fibres; larger: shinier"),
    TL_OPTION_FLOAT(
        material_params, thread, AFFECTS, 0, 1, "",
        "share of the diffuse colour that threads send back as gloss, because light has been inside "
        "them; larger: more contrast, as of satin"),
    TL_OPTION_FLOAT(
        material_params, thread_along, AFFECTS, 0, 1, "",
        "root mean square slope, along the thread, of the band of light that has been inside threads; "
        "it is coloured and lies under the white light of specular; 0: one lobe for both; not with "
        "model phong"),
    TL_OPTION_FLOAT(material_params, thread_across, AFFECTS, 0, 1, "", "the same across the thread"),
    TL_OPTION_FLOAT(
        material_params, warp_share, AFFECTS, 0, 1, "",
        "thread_along: share of the surface in warps, which run along v; the rest is wefts, whose band "
        "is turned by a right angle"),
    TL_OPTION_COLOUR(
        material_params, weft_colour, AFFECTS, 0, 1,
        "thread_along: diffuse albedo of the wefts where it differs from that of the warps, diffuse, "
        "as in shot silk; 0 0 0: the same"),
    TL_OPTION_FLOAT(
        material_params, glossiness, AFFECTS, 0, 1, "",
        "0: reflects in all directions, 1: a mirror; the exponent of the lobe is 1 / (1 - glossiness)"),
    TL_OPTION_ENUM(material_params, model, AFFECTS, model_names, "reflectance model of the glossy lobe"),
    TL_OPTION_ENUM(
        material_params, facets, AFFECTS, facets_names,
        "torrance_sparrow: distribution of the slopes of facets; ggx is that of glTF and U3M, with "
        "width_weft the square of their roughness"),
    TL_OPTION_ENUM(
        material_params, masking, AFFECTS, masking_names,
        "torrance_sparrow: masking and shadowing of facets by one another; schlick: a quotient in place of "
        "smith, darker"),
    TL_OPTION_ENUM(
        material_params, ward, AFFECTS, ward_names,
        "ward: as published, which grows without bound in the last degree of grazing views, or with a "
        "bounded albedo"),
    TL_OPTION_ENUM(material_params, fresnel, AFFECTS, fresnel_names,
                   "rise of reflectance towards grazing angles: from specular, or from the index"),
    TL_OPTION_FLOAT(material_params, index, AFFECTS, 1, 200, "",
                    "index of refraction of dielectric and conductor; larger: reflects more"),
    TL_OPTION_FLOAT(material_params, extinction, AFFECTS, 0, 20, "",
                    "conductor: imaginary part of the index"),
    TL_OPTION_FLOAT(material_params, width_weft, AFFECTS, 0, 1, "",
                    "torrance_sparrow, ward: root mean square slope of facets along the weft; larger: "
                    "duller; 0: from glossiness"),
    TL_OPTION_FLOAT(material_params, width_warp, AFFECTS, 0, 1, "", "ward: the same along the warp"),
    TL_OPTION_FLOAT(material_params, rotation_deg, AFFECTS, -360, 360, "degrees",
                    "ward, banks: rotation of weft and warp, counter-clockwise seen from outside"),
    TL_OPTION_FLOAT(material_params, coat, AFFECTS, 0, 1, "",
                    "fraction of the surface under a clear coat of index 1.5"),
    TL_OPTION_FLOAT(material_params, coat_glossiness, AFFECTS, 0, 1, "", "glossiness of the coat"),
    TL_OPTION_COLOUR(material_params, transmission, AFFECTS, 0, 1,
                     "fraction of light scattered through to the other side; larger: more sheer"),
    TL_OPTION_FLOAT(
        material_params, openness, AFFECTS, 0, 0.99, "",
        "fraction of the surface that is holes between threads; larger: more of the background shows"),
    TL_OPTION_COLOUR(material_params, back, AFFECTS, 0, 1,
                     "diffuse albedo of the inside: the fabric's back, or a lining; 0 0 0: as the front"),
    TL_OPTION_FLOAT(material_params, fuzz, AFFECTS, 0, 1, "",
                    "amount of short fibres that stand on the cloth, as of wool and fleece; larger: a paler "
                    "edge; 0: none"),
    TL_OPTION_COLOUR(material_params, fuzz_colour, AFFECTS, 0, 1, "colour of these fibres"),
    TL_OPTION_FLOAT(material_params, fuzz_roughness, AFFECTS, 0.4, 1, "",
                    "smaller: they show closer to the silhouette only"),
    TL_OPTION_FLOAT(
        material_params, fuzz_follow, AFFECTS, 0, 1, "",
        "0: these fibres stand on the smooth surface, over the weave; 1: they lean with a pile, so "
        "that its patches shine by turns"),
    TL_OPTION_PATH(
        material_params, samples, AFFECTS,
        "measured reflectance, a text file of samples, in place of diffuse, thread, specular, model and "
        "back: "
        "under lamps tables that are factored out of it, for other light lobes that are fitted; empty: none"),
    TL_OPTION_ENUM(
        material_params, on_print, AFFECTS, on_print_names,
        "what becomes of a printed picture of the garment's file under a fabric: replace: the fabric's "
        "colour; tint: multiplied by it; keep: stays as it is"),
};
#define DEFAULTS                                                                                             \
    .use_file = true, .diffuse = {0.5f, 0.5f, 0.5f}, .specular = {0.04f, 0.04f, 0.04f}, .glossiness = 0.5f,  \
    .warp_share = 1, .index = 1.5f, .coat_glossiness = 0.95f, .fuzz_colour = {1, 1, 1},                      \
    .fuzz_roughness = 0.5f

const struct tl_option_table tl_material_options =
    TL_OPTION_TABLE("material", "appearance of the garment: a diffuse and a glossy lobe", material_rows,
                    material_params, DEFAULTS);
