#include "assets/environment/environment.h"

#include "assets/environment/adaptation.h"
#include "assets/image/exr.h"
#include "assets/image/radiance.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void drop_alpha(tl_image *image)
{
    if (image->channels == 3)
        return;
    tl_image colour = tl_image_create(image->width, image->height, 3, TL_IMAGE_F32);
    const float *from = tl_image_floats(image);
    float *to = tl_image_floats(&colour);
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        memcpy(to + 3 * i, from + (size_t)image->channels * i, 3 * sizeof(float));
    tl_image_release(image);
    *image = colour;
}

/* Replaces values that no radiance can have, and counts them: NaN and negative ones by 0, infinities by the
 * largest finite value. */
static void clean_values(tl_environment *environment)
{
    float *values = tl_image_floats(&environment->image);
    size_t count = (size_t)environment->image.width * (size_t)environment->image.height * 3;
    float peak = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i]))
            peak = fmaxf(peak, values[i]);
    for (size_t i = 0; i < count; i++) {
        if (isnan(values[i])) {
            environment->nan_count++;
            values[i] = 0;
        } else if (values[i] < 0) {
            environment->negative_count++;
            values[i] = 0;
        } else if (isinf(values[i])) {
            environment->inf_count++;
            values[i] = peak;
        }
    }
    environment->peak = peak;
}

/* Converts six faces in a row to six faces in a column. */
static void stack_faces(tl_image *image)
{
    size_t side = (size_t)image->height, row = 3 * side;
    tl_image stacked = tl_image_create((int)side, (int)(6 * side), 3, TL_IMAGE_F32);
    for (size_t face = 0; face < 6; face++)
        for (size_t y = 0; y < side; y++)
            memcpy(tl_image_floats(&stacked) + (face * side + y) * row,
                   tl_image_floats(image) + (y * 6 + face) * row, row * sizeof(float));
    tl_image_release(image);
    *image = stacked;
}

/* Converts a cube from OpenEXR's convention (ImfEnvmap.h) to GL's.
 *
 * At its centre OpenEXR's lat-long image looks along +Z, with +X to the left; ours along -Z, with +X to the
 * right. Lat-long images are used as they are, by our convention, which turns OpenEXR's world half around Y:
 * (x, y, z) ->
 * (-x, y, -z). A cube must be turned in the same way: +X and -X change places, and +Z and -Z. Besides,
 * OpenEXR's faces are seen from inside the cube, GL's from outside, so each is mirrored left to right.
 * OpenEXR's outermost samples lie on the cube's edges, ours half a texel inside: that difference is not
 * corrected. */
static void turn_openexr_cube(tl_image *image)
{
    static const size_t source[6] = {1, 0, 2, 3, 5, 4};
    size_t side = (size_t)image->width;
    tl_image turned = tl_image_create(image->width, image->height, 3, TL_IMAGE_F32);
    for (size_t row = 0; row < 6 * side; row++) {
        const float *from = tl_image_floats(image) + (source[row / side] * side + row % side) * side * 3;
        float *to = tl_image_floats(&turned) + row * side * 3;
        for (size_t x = 0; x < side; x++)
            memcpy(to + 3 * x, from + 3 * (side - 1 - x), 3 * sizeof(float));
    }
    tl_image_release(image);
    *image = turned;
}

/* The layout that a file of `toile env` states; lat-long for others. */
static enum tl_env_layout stated_layout(enum tl_exr_envmap kind)
{
    return kind == TL_EXR_SPHERE       ? TL_ENV_SPHERE
           : kind == TL_EXR_PARABOLOID ? TL_ENV_PARABOLOID
           : kind == TL_EXR_OCTAHEDRAL ? TL_ENV_OCTAHEDRAL
                                       : TL_ENV_LATLONG;
}

static bool arrange(const char *path, enum tl_exr_envmap kind, tl_environment *environment, tl_error *error)
{
    tl_image *image = &environment->image;
    environment->layout = stated_layout(kind);
    if (environment->layout != TL_ENV_LATLONG) {
        const int wide = environment->layout == TL_ENV_PARABOLOID ? 2 : 1;
        return (int64_t)image->width == wide * (int64_t)image->height ||
               tl_fail(error, TL_INPUT,
                       "%s: its comments state a map of %d:1, but it is %d x %d texels: write it again", path,
                       wide, image->width, image->height);
    }
    bool upright = (int64_t)image->height == 6 * (int64_t)image->width;
    bool lying = (int64_t)image->width == 6 * (int64_t)image->height;
    if (kind == TL_EXR_CUBE && !upright)
        return tl_fail(error, TL_INPUT,
                       "%s: is marked as a cube map but is %d x %d texels: six square faces must be stacked",
                       path, image->width, image->height);
    environment->layout = kind != TL_EXR_LATLONG && (upright || lying) ? TL_ENV_CUBE : TL_ENV_LATLONG;
    if (environment->layout == TL_ENV_CUBE && lying)
        stack_faces(image);
    if (kind == TL_EXR_CUBE)
        turn_openexr_cube(image);
    return true;
}

static bool load_radiance(const char *path, tl_image *out, tl_error *error)
{
    char *data;
    size_t size;
    if (!tl_file_read(path, &data, &size, error))
        return false;
    bool loaded = tl_radiance_decode(path, data, size, out, error);
    free(data);
    return loaded;
}

void tl_environment_adapt(tl_environment *environment)
{
    if (environment->layout != TL_ENV_LATLONG && environment->layout != TL_ENV_CUBE)
        return;
    environment->shown = tl_adaptation_to(environment);
    environment->ground = tl_adaptation_ground(environment);
}

/* The content decides, not the extension. */
static bool is_radiance(const char *path)
{
    char start[2] = "";
    FILE *stream = fopen(path, "rb");
    size_t got = stream ? fread(start, 1, sizeof start, stream) : 0;
    if (stream)
        fclose(stream);
    return tl_radiance_begins(start, got);
}

/* Names, cleans and arranges what holds a picture; releases it on failure. */
static bool finish(const char *path, enum tl_exr_envmap kind, tl_environment *environment, tl_error *error)
{
    const char *slash = strrchr(path, '/');
    drop_alpha(&environment->image);
    clean_values(environment);
    if (!arrange(path, kind, environment, error)) {
        tl_environment_release(environment);
        return false;
    }
    environment->name = tl_copy_string(slash ? slash + 1 : path);
    tl_environment_adapt(environment);
    return true;
}

bool tl_environment_take(const char *path, tl_image *image, tl_environment *out, tl_error *error)
{
    *out = (tl_environment){.image = *image};
    *image = (tl_image){0};
    return finish(path, TL_EXR_NOT_ENVMAP, out, error);
}

bool tl_environment_load(const char *path, tl_environment *out, tl_error *error)
{
    *out = (tl_environment){0};
    if (!tl_file_check(path, error))
        return false;
    tl_environment environment = {0};
    enum tl_exr_envmap kind = TL_EXR_NOT_ENVMAP;
    if (is_radiance(path) ? !load_radiance(path, &environment.image, error)
                          : !tl_exr_load(path, &environment.image, &kind, error))
        return false;
    if (!finish(path, kind, &environment, error))
        return false;
    *out = environment;
    return true;
}
