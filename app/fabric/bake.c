#include "app/fabric/bake.h"

#include "app/textures/height_picture.h"
#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/detail/bake.h"
#include "render/detail/cones.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_REPEAT_MM 10.0f
#define DEFAULT_HEIGHT_MM 0.5f
#define DEFAULT_GLOSS     0.9f
#define GLOSS_WINDOW      4 /* texels; the gloss map describes the normals of such a square */

static bool check_arguments(const struct tl_arguments *arguments, tl_error *error)
{
    if (arguments->positional_count != 1)
        return tl_fail(error, TL_USAGE,
                       "fabric: expected one height map: toile fabric IN.png -o FOLDER --repeat-mm 10");
    if (!arguments->output)
        return tl_fail(error, TL_USAGE, "fabric: no output: add -o FOLDER");
    return true;
}

struct baking {
    const struct tl_arguments *arguments;
    float width_m, height_m; /* of a repeat */
    float depth_m;           /* from the lowest point to the highest */
    tl_image heights;
    struct tl_height_field field; /* borrows `heights` */
};

/* The struct must not be moved afterwards: `field` points to `heights`. */
static void begin(struct baking *baking, const tl_image *picture)
{
    const struct tl_arguments *given = baking->arguments;
    baking->width_m = 1e-3f * (given->repeat_mm > 0 ? (float)given->repeat_mm : DEFAULT_REPEAT_MM);
    baking->height_m = baking->width_m * (float)picture->height / (float)picture->width;
    baking->depth_m = 1e-3f * (given->height_mm > 0 ? (float)given->height_mm : DEFAULT_HEIGHT_MM);
    baking->heights = tl_bake_heights(picture, 0, baking->depth_m);
    baking->field =
        tl_height_field_make(&baking->heights, baking->width_m, baking->height_m, given->clamp, given->clamp);
}

static void log_map(const char *path, const tl_image *image)
{
    tl_info("%s: %d x %d texels, %zu bytes in memory", path, image->width, image->height,
            tl_image_size_bytes(image));
}

static bool save_png(const struct baking *baking, const char *name, tl_image *image, tl_error *error)
{
    char *path = tl_format("%s/%s.png", baking->arguments->output, name);
    bool saved = tl_image_save_png(path, image, error);
    if (saved)
        log_map(path, image);
    free(path);
    tl_image_release(image);
    return saved;
}

static bool save_exr(const struct baking *baking, const char *name, const char *const *channels,
                     tl_image *image, tl_error *error)
{
    char *path = tl_format("%s/%s.exr", baking->arguments->output, name);
    const struct tl_exr_layer layer = {channels, image};
    bool saved = tl_exr_save(path, &layer, 1, error);
    if (saved)
        log_map(path, image);
    free(path);
    tl_image_release(image);
    return saved;
}

static bool save_normals(const struct baking *baking, tl_error *error)
{
    static const char *const moment_names[] = {"x", "y", "xx", "yy"};
    tl_image slopes = tl_bake_slopes(&baking->field), normals = tl_bake_normals(&slopes, 1);
    tl_image bytes = tl_bake_encoded(&normals), moments = tl_bake_moments(&normals, false),
             gloss = tl_bake_gloss(&moments, DEFAULT_GLOSS, GLOSS_WINDOW);
    bool saved = save_png(baking, "normal", &bytes, error);
    saved = saved && save_exr(baking, "moments", moment_names, &moments, error);
    saved = saved && save_png(baking, "gloss", &gloss, error);
    tl_image *made[] = {&slopes, &normals, &bytes, &moments, &gloss};
    for (size_t i = 0; i < TL_COUNT(made); i++)
        tl_image_release(made[i]);
    return saved;
}

static bool save_horizons(const struct baking *baking, tl_error *error)
{
    struct tl_horizon_maps maps = tl_bake_horizons(&baking->field, 8);
    bool saved = save_png(baking, "horizon_0_45_90_135", &maps.images[0], error) &&
                 save_png(baking, "horizon_180_225_270_315", &maps.images[1], error);
    tl_horizon_maps_release(&maps);
    return saved;
}

/* Saves a picture whose red channel holds the cones of the front, green those of the back. */
static bool save_cones(const struct baking *baking, tl_error *error)
{
    tl_image cones = tl_bake_cones(&baking->field, 1),
             picture = tl_image_create(cones.width, cones.height, 3, TL_IMAGE_U8);
    picture.linear = true;
    for (size_t i = 0; i < (size_t)cones.width * (size_t)cones.height; i++)
        memcpy(tl_image_bytes(&picture) + 3 * i, tl_image_bytes(&cones) + 2 * i, 2);
    tl_image_release(&cones);
    return save_png(baking, "cones", &picture, error);
}

static bool save_heights(const struct baking *baking, tl_error *error)
{
    static const char *const names[] = {"Y"};
    tl_image heights = tl_bake_heights(&baking->heights, 0, 1);
    return save_exr(baking, "height", names, &heights, error);
}

/* The file's name without folder and extension, as a new string. */
static char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *name = tl_copy_string(slash ? slash + 1 : path), *dot = strrchr(name, '.');
    if (dot && dot != name)
        *dot = '\0';
    return name;
}

/* Saves the fabric for --fabric. The renderer reads height.exr and bakes its own maps; the others are for
 * other programs. */
static bool save_fabric(const struct baking *baking, tl_error *error)
{
    struct tl_writer writer;
    char *name = name_of(baking->arguments->positionals[0]),
         *path = tl_format("%s/%s.yaml", baking->arguments->output, name);
    bool saved = tl_writer_begin(&writer, path, error);
    if (saved) {
        fprintf(writer.stream,
                "# Baked by toile fabric; --fabric takes this file.\n"
                "# For other programs: normal.png, moments.exr, gloss.png, "
                "horizon_*.png, cones.png.\n"
                "weave:\n"
                "  picture: height.exr # metres; a repeat of %g x %g mm\n"
                "  picture_mm: %g\n"
                "  depth_mm: %g # from the lowest to the highest\n"
                "# Choose the appearance.\n"
                "material:\n"
                "  use_file: false\n"
                "  diffuse: [0.5, 0.5, 0.5]\n"
                "  specular: [0.04, 0.04, 0.04]\n"
                "  glossiness: 0.5\n",
                1e3 * (double)baking->width_m, 1e3 * (double)baking->height_m, 1e3 * (double)baking->width_m,
                1e3 * (double)(baking->field.high_m - baking->field.low_m));
        saved = tl_writer_commit(&writer, error);
    }
    if (saved)
        tl_info("%s: use it with --fabric %s", path, path);
    free(path);
    free(name);
    return saved;
}

static float steepest(const struct baking *baking)
{
    tl_image slopes = tl_bake_slopes(&baking->field);
    float maximum = 0;
    for (size_t i = 0; i < (size_t)slopes.width * (size_t)slopes.height; i++)
        maximum =
            fmaxf(maximum, hypotf(tl_image_floats(&slopes)[2 * i], tl_image_floats(&slopes)[2 * i + 1]));
    tl_image_release(&slopes);
    return maximum;
}

bool tl_fabric_bake(const struct tl_arguments *arguments, tl_error *error)
{
    tl_image picture;
    if (!check_arguments(arguments, error) ||
        !tl_height_picture_load(arguments->positionals[0], &picture, error))
        return false;
    struct baking baking = {.arguments = arguments};
    begin(&baking, &picture);
    tl_image_release(&picture);
    bool done = tl_folder_make(arguments->output, error) && save_normals(&baking, error) &&
                save_horizons(&baking, error) && save_cones(&baking, error) && save_heights(&baking, error) &&
                save_fabric(&baking, error);
    if (done)
        tl_info("%s: %g x %g mm a repeat, %g mm deep, slopes to %.3g", arguments->output,
                1e3 * (double)baking.width_m, 1e3 * (double)baking.height_m,
                1e3 * (double)(baking.field.high_m - baking.field.low_m), (double)steepest(&baking));
    tl_image_release(&baking.heights);
    return done;
}
