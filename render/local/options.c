#include "render/brdf/tables/tables.h"
#include "render/local/shading.h"
#include "render/plan/affects.h"

static const char *const frequency_names[] = {"gouraud", "fast_phong", "phong", NULL};
static const char *const coordinates_names[] = {"matrix", "vertex", "pixel", NULL};
static const char *const reflectance_names[] = {"direct", "table", "factored", NULL};
static const char *const terms_names[] = {"gloss", "all", NULL};
static const char *const precision_names[] = {"fixed8", "fixed16", "float", NULL};
static const char *const range_names[] = {"clamped", "scaled", NULL};
const char *const tl_pass_target_names[] = {"fixed8", "float", NULL};
static const char *const power_names[] = {"pow", "fixed8", "table", NULL};
static const char *const space_names[] = {"world", "tangent", "texture", "object", NULL};
static const char *const self_shadow_names[] = {"step", "ramp", NULL};

#define AFFECTS (TL_AFFECTS_APPEARANCE | TL_AFFECTS_LAMPS)

typedef struct tl_shading_params params;
static const struct tl_option rows[] = {
    TL_OPTION_ENUM(
        params, frequency, AFFECTS, frequency_names,
        "place of evaluation: vertices; pixels with interpolated vectors; pixels with renormalised vectors"),
    TL_OPTION_ENUM(params, coordinates, AFFECTS, coordinates_names,
                   "origin of the cosines: one matrix, for a distant light and viewer; interpolation from "
                   "vertices, without bumps; vectors at pixels"),
    TL_OPTION_ENUM(
        params, reflectance, AFFECTS, reflectance_names,
        "gloss by its formula; or from tables of the material, which ignore gloss maps: factors of the "
        "formula, or factored numerically out of samples of it"),
    TL_OPTION_ENUM(
        params, table_terms, AFFECTS, terms_names,
        "reflectance=table: what a table holds: gloss, which the diffuse light is added to; or all "
        "light of a phong, blinn_phong or cosine_lobe material of one even colour, Fresnel's term "
        "being that at normal incidence; others keep gloss"),
    TL_OPTION_INT(params, table_size, AFFECTS, 8, 512, "texels", "side of a table; larger: more exact"),
    TL_OPTION_ENUM(params, table_precision, AFFECTS, precision_names, "precision of the values of a table"),
    TL_OPTION_ENUM(params, table_range, AFFECTS, range_names,
                   "fixed-point tables of a factor that is unbounded at grazing angles: clamped to 1, or "
                   "divided by its maximum"),
    TL_OPTION_INT(params, max_textures_per_pass, AFFECTS, 1, 4, "tables",
                  "tables multiplied in one pass; smaller: more passes for gloss with more tables"),
    TL_OPTION_ENUM(params, pass_target, AFFECTS, tl_pass_target_names,
                   "precision of the target in which passes are multiplied, and of textures over UVs"),
    TL_OPTION_ENUM(
        params, normalisation, AFFECTS, tl_normalisation_names,
        "phong: renormalisation of vectors; all methods but exact start from interpolated vectors; newton, "
        "taylor2, taylor3: terms of a series; newton8: in 8 bits and a sign, dot products too; slerp: evenly "
        "turning between corners, in world space"),
    TL_OPTION_ENUM(params, power, AFFECTS, power_names,
                   "evaluation of powers of cosines in the direct formula"),
    TL_OPTION_ENUM(
        params, space, AFFECTS, space_names,
        "space of vectors at pixels: world, or tangent space by a transformation at vertices; texture: "
        "bumps are lit at texels over the UVs, and what is lit is mapped to the surface; object: "
        "normals with their bumps come from a map of them in the pose in which they are first drawn, which "
        "follows rigid motion but no bends; parts whose UVs overlap are lit in world space"),
    TL_OPTION_INT(params, texture_size, AFFECTS, 8, 4096, "texels",
                  "texture, object: side of what lies over the UVs of a part; larger: finer bumps"),
    TL_OPTION_FLOAT(params, ambient, AFFECTS, 0, 1, "",
                    "light from all around that a lamp stands for, as a share of its irradiance; no shadow "
                    "takes it away; 0: none"),
    TL_OPTION_ENUM(params, self_shadow, AFFECTS, self_shadow_names,
                   "end of light at the horizon of the smooth surface: a step, or a steep ramp"),
};
const struct tl_option_table tl_shading_options = TL_OPTION_TABLE(
    "shading", "shading of surfaces by lamps", rows, params, .frequency = TL_FREQUENCY_PHONG,
    .coordinates = TL_COORDINATES_PIXEL, .reflectance = TL_REFLECTANCE_DIRECT, .table_size = 256,
    .table_precision = TL_PRECISION_FLOAT, .table_range = TL_RANGE_SCALED, .max_textures_per_pass = 4,
    .pass_target = TL_PASS_TARGET_FLOAT, .normalisation = TL_NORMALISE_EXACT, .power = TL_POWER_POW,
    .space = TL_SPACE_WORLD, .texture_size = 1024, .self_shadow = TL_SELF_SHADOW_RAMP);
