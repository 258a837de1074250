/* The tables of cloth, assets and render, for as long as the settings are tested without these floors. */
#include "app/settings.h"

static const char *const solvers[] = {"xpbd", NULL};
static const char *const patterns[] = {"none", "plain", "twill", "satin", NULL};
static const char *const methods[] = {"pem", "unshadowed", NULL};
static const char *const lobes[] = {"single", "dual", NULL};
static const char *const filters[] = {"none", "gauss", "cosine", "box", "sqrt_cosine", NULL};
static const char *const backgrounds[] = {"environment", "blurred", "grey", NULL};

static const struct tl_option cloth_rows[] = {
    TL_OPTION_ENUM(struct tl_cloth_params, solver, solvers, "-"),
    {"dt", TL_DOUBLE, offsetof(struct tl_cloth_params, dt), 1e-5, 0.1, NULL, "s", "-"},
    TL_OPTION_INT(struct tl_cloth_params, substeps, 1, 1000, "", "-"),
};
const struct tl_option_table tl_cloth_options =
    TL_OPTION_TABLE("cloth", "-", cloth_rows, struct tl_cloth_params, .dt = 0.01, .substeps = 8);

static const struct tl_option fabric_rows[] = {
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, areal_density, 1e-4, 100, "kg/m^2", "-"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, stretch_weft, 0, 1e9, "N/m", "-"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, stretch_warp, 0, 1e9, "N/m", "-"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, shear, 0, 1e9, "N/m", "-"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, bend_weft, 0, 1e3, "N m", "-"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, bend_warp, 0, 1e3, "N m", "-"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, damping, 0, 1e3, "1/s", "-"),
    TL_OPTION_DOUBLE(struct tl_cloth_fabric, friction, 0, 10, "", "-"),
};
const struct tl_option_table tl_cloth_fabric_options = TL_OPTION_TABLE(
    "fabric", "-", fabric_rows, struct tl_cloth_fabric, .areal_density = 0.15, .damping = 0.5);

static const struct tl_option weave_rows[] = {
    TL_OPTION_ENUM(struct tl_weave_params, pattern, patterns, "-"),
    TL_OPTION_FLOAT(struct tl_weave_params, warp_pitch_mm, 0.01, 100, "mm", "-"),
    TL_OPTION_FLOAT(struct tl_weave_params, weft_pitch_mm, 0.01, 100, "mm", "-"),
    TL_OPTION_FLOAT(struct tl_weave_params, crimp_mm, 0, 100, "mm", "-"),
    TL_OPTION_FLOAT(struct tl_weave_params, warp_gloss, -1, 1, "", "-"),
    TL_OPTION_FLOAT(struct tl_weave_params, weft_gloss, -1, 1, "", "-"),
    TL_OPTION_COLOUR(struct tl_weave_params, warp_tint, 0, 1, "-"),
    TL_OPTION_COLOUR(struct tl_weave_params, weft_tint, 0, 1, "-"),
};
const struct tl_option_table tl_weave_options =
    TL_OPTION_TABLE("weave", "-", weave_rows, struct tl_weave_params, .pattern = TL_WEAVE_PLAIN,
                    .warp_pitch_mm = 1, .weft_pitch_mm = 1);

static const struct tl_option material_rows[] = {
    TL_OPTION_BOOL(struct tl_material_params, use_file, "-"),
    TL_OPTION_COLOUR(struct tl_material_params, diffuse, 0, 1, "-"),
    TL_OPTION_COLOUR(struct tl_material_params, specular, 0, 1, "-"),
    TL_OPTION_FLOAT(struct tl_material_params, glossiness, 0, 1, "", "-"),
};
const struct tl_option_table tl_material_options =
    TL_OPTION_TABLE("material", "-", material_rows, struct tl_material_params, .glossiness = 0.5f);

static const struct tl_option light_rows[] = {
    TL_OPTION_ENUM(struct tl_light_params, method, methods, "-"),
    TL_OPTION_ENUM(struct tl_light_params, lobe, lobes, "-"),
    TL_OPTION_INT(struct tl_light_params, regions, 6, 384, "", "-"),
    TL_OPTION_INT(struct tl_light_params, pem_size, 8, 512, "texels", "-"),
    TL_OPTION_ENUM(struct tl_light_params, filter, filters, "-"),
    TL_OPTION_INT(struct tl_light_params, pems_per_pass, 1, 64, "", "-"),
    TL_OPTION_INT(struct tl_light_params, map_size, 1, 4096, "texels", "-"),
    TL_OPTION_FLOAT(struct tl_light_params, blur_m, 0, 10, "m", "-"),
};
const struct tl_option_table tl_light_options = TL_OPTION_TABLE(
    "light", "-", light_rows, struct tl_light_params, .regions = 6, .pem_size = 8, .blur_m = 0.1f);

static const struct tl_option image_rows[] = {
    TL_OPTION_INT(struct tl_image_params, width, 1, 16384, "pixels", "-"),
    TL_OPTION_INT(struct tl_image_params, height, 1, 16384, "pixels", "-"),
    TL_OPTION_INT(struct tl_image_params, supersample, 1, 8, "", "-"),
    TL_OPTION_ENUM(struct tl_image_params, background, backgrounds, "-"),
};
const struct tl_option_table tl_image_options = TL_OPTION_TABLE(
    "image", "-", image_rows, struct tl_image_params, .width = 960, .height = 540, .supersample = 1);
