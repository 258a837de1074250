#include "app/textures/height_picture.h"

#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "render/detail/bake.h"

#include <math.h>
#include <string.h>

/* Larger than any GL here draws. */
#define SIDE_MAX 8192

bool tl_height_picture_load(const char *path, tl_image *out, tl_error *error)
{
    if (!tl_path_has_extension(path, "exr"))
        return tl_image_load_values(path, out, error);
    enum tl_exr_envmap unused;
    if (!tl_exr_load(path, out, &unused, error))
        return false;
    size_t count = (size_t)out->width * (size_t)out->height * (size_t)out->channels;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(tl_image_floats(out)[i])) {
            tl_image_release(out);
            return tl_fail(error, TL_INPUT,
                           "%s: holds a value that is not finite: correct it in the program that made it",
                           path);
        }
    return true;
}

/* The first channel from 0, its lowest value, to 1, its highest: limits[0] and [1]. */
static tl_image spread(const tl_image *picture, float limits[2])
{
    tl_image heights = tl_bake_heights(picture, 0, 1);
    float *values = tl_image_floats(&heights), low = INFINITY, high = -INFINITY;
    size_t count = (size_t)heights.width * (size_t)heights.height;
    for (size_t i = 0; i < count; i++) {
        low = fminf(low, values[i]);
        high = fmaxf(high, values[i]);
    }
    limits[0] = low;
    limits[1] = high;
    for (size_t i = 0; i < count; i++)
        values[i] = high > low ? (values[i] - low) / (high - low) : 0.5f;
    return heights;
}

/* Converts heights to metres above the fabric's middle plane. */
static tl_image heights_of(const tl_image *picture, float depth_m)
{
    float limits[2];
    tl_image heights = spread(picture, limits);
    size_t count = (size_t)heights.width * (size_t)heights.height;
    for (size_t i = 0; i < count; i++)
        tl_image_floats(&heights)[i] = depth_m * (tl_image_floats(&heights)[i] - 0.5f);
    return heights;
}

bool tl_height_picture_metres(const char *path, tl_image *out, float limits_m[2], tl_error *error)
{
    tl_image picture;
    if (!tl_path_has_extension(path, "exr"))
        return tl_fail(error, TL_INPUT, "%s: heights in metres are an .exr file: `toile bake` writes one",
                       path);
    if (!tl_height_picture_load(path, &picture, error))
        return false;
    *out = spread(&picture, limits_m);
    tl_image_release(&picture);
    return true;
}

bool tl_normal_picture_load(const char *path, tl_image *out, tl_error *error)
{
    tl_image picture;
    if (!tl_image_load(path, &picture, error))
        return false;
    if (picture.channels < 3) {
        tl_image_release(&picture);
        return tl_fail(error, TL_INPUT, "%s: has no colours: a normal map has three", path);
    }
    size_t texels = (size_t)picture.width * (size_t)picture.height, channels = (size_t)picture.channels;
    *out = tl_image_create(picture.width, picture.height, 3, TL_IMAGE_U8);
    for (size_t i = 0; i < texels; i++)
        memcpy(tl_image_bytes(out) + 3 * i, tl_image_bytes(&picture) + channels * i, 3);
    tl_image_release(&picture);
    return true;
}

bool tl_height_picture_weave(const struct tl_weave_params *params, tl_weave *out, tl_error *error)
{
    tl_image picture;
    *out = (tl_weave){0};
    if (!tl_height_picture_load(params->picture, &picture, error))
        return false;
    int width = picture.width, height = picture.height;
    if (width > SIDE_MAX || height > SIDE_MAX) {
        tl_image_release(&picture);
        return tl_fail(error, TL_INPUT, "%s: %d x %d texels are too many for a weave: scale it to %d",
                       params->picture, width, height, SIDE_MAX);
    }
    float width_m = 1e-3f * tl_weave_picture_mm(params);
    *out = (tl_weave){.size_m = {width_m, width_m * (float)height / (float)width},
                      .height = heights_of(&picture, 1e-3f * params->depth_mm),
                      .gloss = tl_image_create(width, height, 1, TL_IMAGE_F32),
                      .tint = tl_image_create(width, height, 3, TL_IMAGE_F32)};
    for (size_t i = 0; i < 3 * (size_t)width * (size_t)height; i++)
        tl_image_floats(&out->tint)[i] = 1;
    struct tl_height_field field =
        tl_height_field_make(&out->height, out->size_m[0], out->size_m[1], false, false);
    tl_image slopes = tl_bake_slopes(&field), normals = tl_bake_normals(&slopes, 1);
    out->normal = tl_bake_encoded(&normals);
    tl_image_release(&picture);
    tl_image_release(&slopes);
    tl_image_release(&normals);
    return true;
}
