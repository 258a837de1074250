#include "render/present/options.h"

#include "render/pem/regions.h"
#include "render/plan/affects.h"

#include <math.h>

typedef struct tl_image_params image_params;
static const char *const background_names[] = {"environment", "blurred", "grey", NULL};
const char *const tl_image_view_names[] = {
    "light",      "normal", "smooth",      "tangent",     "uv",           "albedo",   "gloss",
    "visibility", "region", "strain_warp", "strain_weft", "strain_shear", "crossing", NULL};

static const struct tl_option image_rows[] = {
    TL_OPTION_INT(image_params, width, TL_AFFECTS_SIZE | TL_AFFECTS_AT_ONCE | TL_AFFECTS_WORK, 1, 16384,
                  "pixels", "width of the image"),
    TL_OPTION_INT(image_params, height, TL_AFFECTS_SIZE | TL_AFFECTS_AT_ONCE | TL_AFFECTS_WORK, 1, 16384,
                  "pixels", "height of the image"),
    TL_OPTION_INT(image_params, supersample, TL_AFFECTS_SIZE | TL_AFFECTS_APPEARANCE | TL_AFFECTS_WORK, 1, 8,
                  "", "samples per pixel side; larger: smoother edges and weave, time grows with the square"),
    TL_OPTION_FLOAT(image_params, exposure_ev, TL_AFFECTS_SHOW | TL_AFFECTS_AT_ONCE, -20, 20, "EV",
                    "brightness on the screen and in PNG files, in stops; EXR files are not affected"),
    TL_OPTION_BOOL(image_params, adapt, TL_AFFECTS_SHOW | TL_AFFECTS_AT_ONCE,
                   "shows light from environment files as bright as the studio's and nearly as white, as the "
                   "eye adapts; EXR files are not affected"),
    TL_OPTION_ENUM(image_params, background, TL_AFFECTS_SHOW | TL_AFFECTS_AT_ONCE, background_names,
                   "background, on the screen and in PNG files"),
    TL_OPTION_BOOL(image_params, ground, TL_AFFECTS_GROUND | TL_AFFECTS_SCENE | TL_AFFECTS_DRAPE,
                   "a matt disc at y = 0 that receives shadows"),
    TL_OPTION_FLOAT(image_params, ground_grey, TL_AFFECTS_GROUND, 0, 1, "",
                    "reflectance of that disc; 0: of the ground that the environment file shows"),
    TL_OPTION_ENUM(
        image_params, view, TL_AFFECTS_VIEW, tl_image_view_names,
        "content of the image: light, a quantity that it is computed from, or the strain of the cloth"),
    TL_OPTION_INT(image_params, view_region, TL_AFFECTS_VIEW_SCALE, -1, TL_REGIONS_MAX - 1, "",
                  "view=visibility: visibility of this region alone; -1: of all, weighted by their power"),
    TL_OPTION_FLOAT(image_params, view_range, TL_AFFECTS_VIEW_SCALE, 0, 1000, "%",
                    "views of strain: strain at the ends of the legend; 0: the range of 99 % of the cloth"),
    TL_OPTION_FLOAT(image_params, scale, TL_AFFECTS_SIZE, 0.1, 1, "",
                    "samples per side, relative to supersample; smaller: faster, softer"),
    TL_OPTION_BOOL(image_params, legend, TL_AFFECTS_NOTHING,
                   "draws a legend into images of views other than light"),
};
const struct tl_option_table tl_image_options = TL_OPTION_TABLE(
    "image", "size, quality and content of the image", image_rows, image_params, .width = 960, .height = 540,
    .supersample = 1, .exposure_ev = 0, .adapt = true, .background = TL_BACKGROUND_BLURRED, .ground = true,
    .ground_grey = 0, .scale = 1, .view = TL_VIEW_LIGHT, .view_region = -1, .view_range = 0, .legend = true);

static int scaled(int side, const struct tl_image_params *image)
{
    long samples = lround((double)side * image->supersample * (double)image->scale);
    return samples > 1 ? (int)samples : 1;
}

void tl_image_samples(const struct tl_image_params *image, int *width, int *height)
{
    *width = scaled(image->width, image);
    *height = scaled(image->height, image);
}
