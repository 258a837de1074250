#include "assets/image/exr.h"
#include "assets/image/image_file.h"
#include "assets/swatch/swatch.h"
#include "config/base/file.h"
#include "config/colour/srgb.h"

#include <math.h>

#define SATURATED_BYTE 250
#define SATURATED_MAX  0.1

/* Linear values of the texels of a picture. */
struct decoded {
    tl_image image;
    float linear[256]; /* by byte */
};

/* False for a saturated texel. */
static bool read_texel(const struct decoded *from, size_t index, float out[3])
{
    int channels = from->image.channels, colours = channels < 3 ? 1 : 3;
    bool saturated = false;
    for (int c = 0; c < 3; c++) {
        size_t at = index * (size_t)channels + (size_t)(c < colours ? c : 0);
        if (from->image.type == TL_IMAGE_F32) {
            out[c] = tl_image_floats(&from->image)[at];
            continue;
        }
        uint8_t byte = tl_image_bytes(&from->image)[at];
        saturated = saturated || byte >= SATURATED_BYTE;
        out[c] = from->linear[byte];
    }
    return !saturated;
}

static void average(const struct decoded *from, int step, int x, int y, float out[3])
{
    float texel[3];
    double sum[3] = {0};
    bool good = true;
    for (int v = y * step; v < (y + 1) * step; v++)
        for (int u = x * step; u < (x + 1) * step; u++) {
            good = read_texel(from, (size_t)v * (size_t)from->image.width + (size_t)u, texel) && good;
            for (int c = 0; c < 3; c++)
                sum[c] += (double)texel[c];
        }
    for (int c = 0; c < 3; c++)
        out[c] = good ? (float)(sum[c] / (double)(step * step)) : -1;
}

static bool decode(const char *path, struct decoded *out, tl_error *error)
{
    enum tl_exr_envmap unused;
    for (int byte = 0; byte < 256; byte++)
        out->linear[byte] = tl_srgb_to_linear((float)byte / 255);
    return tl_path_has_extension(path, "exr") ? tl_exr_load(path, &out->image, &unused, error)
                                              : tl_image_load(path, &out->image, error);
}

/* Whether values are finite and few are saturated. */
static bool check(const char *path, const tl_image *picture, tl_error *error)
{
    size_t count = (size_t)picture->width * (size_t)picture->height, saturated = 0;
    for (size_t i = 0; i < count; i++) {
        const float *texel = tl_image_floats(picture) + 3 * i;
        if (!isfinite(texel[0]) || !isfinite(texel[1]) || !isfinite(texel[2]))
            return tl_fail(error, TL_INPUT, "%s: holds a value that is not finite: take it again", path);
        saturated += texel[0] == -1;
    }
    return (double)saturated <= SATURATED_MAX * (double)count ||
           tl_fail(error, TL_INPUT, "%s: %.0f %% of it is saturated: expose it for a shorter time", path,
                   100 * (double)saturated / (double)count);
}

bool tl_swatch_picture_load(const char *path, tl_image *out, tl_error *error)
{
    struct decoded from = {0};
    *out = (tl_image){0};
    if (!decode(path, &from, error))
        return false;
    int longest = from.image.width > from.image.height ? from.image.width : from.image.height,
        step = (longest + TL_SWATCH_SIDE_MAX - 1) / TL_SWATCH_SIDE_MAX;
    step = step > from.image.width || step > from.image.height ? 1 : step;
    *out = tl_image_create(from.image.width / step, from.image.height / step, 3, TL_IMAGE_F32);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < out->height; y++)
        for (int x = 0; x < out->width; x++)
            average(&from, step, x, y,
                    tl_image_floats(out) + 3 * ((size_t)y * (size_t)out->width + (size_t)x));
    tl_image_release(&from.image);
    if (check(path, out, error))
        return true;
    tl_image_release(out);
    return false;
}
