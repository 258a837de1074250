#include "render/trace/cutout.h"

#include "config/colour/srgb.h"

#include <math.h>

/* Texel index along one side, wrapped as in GL. `at` is an integer. */
static int wrap(float at, int size, bool clamp)
{
    if (clamp)
        return (int)fminf(fmaxf(at, 0), (float)(size - 1));
    float turns = floorf(at / (float)size);
    int index = (int)(at - turns * (float)size);
    return index < 0 ? 0 : index >= size ? size - 1 : index;
}

/* The four texels around a point, and their weights. */
struct taps {
    size_t texels[4];
    float weights[4];
};

/* False where the coordinates are not finite. */
static bool taps_at(const struct tl_map *map, vec2s uv, struct taps *out)
{
    const tl_image *image = map->image;
    vec2s at = tl_uv_transformed(&map->transform, uv);
    float x = at.x * (float)image->width - 0.5f, y = at.y * (float)image->height - 0.5f;
    if (!isfinite(x) || !isfinite(y))
        return false;
    float left = floorf(x), top = floorf(y), across = x - left, down = y - top;
    for (int i = 0; i < 4; i++) {
        int column = wrap(left + (float)(i % 2), image->width, map->clamp_u);
        int row = wrap(top + (float)(i / 2), image->height, map->clamp_v);
        out->texels[i] = (size_t)row * (size_t)image->width + (size_t)column;
        out->weights[i] = (i % 2 ? across : 1 - across) * (i / 2 ? down : 1 - down);
    }
    return true;
}

static float channel_of(const tl_image *image, size_t texel, int channel)
{
    size_t at = texel * (size_t)image->channels + (size_t)channel;
    return image->type == TL_IMAGE_U8 ? (float)tl_image_bytes(image)[at] / 255 : tl_image_floats(image)[at];
}

static bool has_alpha(const tl_image *image)
{
    return image && (image->channels == 2 || image->channels == 4);
}

static float bilinear_alpha(const struct tl_map *map, vec2s uv)
{
    struct taps taps;
    float sum = 0;
    if (!taps_at(map, uv, &taps))
        return 1;
    for (int i = 0; i < 4; i++)
        sum += taps.weights[i] * channel_of(map->image, taps.texels[i], map->image->channels - 1);
    return sum;
}

vec3s tl_map_colour_at(const struct tl_map *map, vec2s uv)
{
    const tl_image *image = map->image;
    struct taps taps;
    vec3s sum = {{0, 0, 0}};
    if (!image || !taps_at(map, uv, &taps))
        return (vec3s){{1, 1, 1}};
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++) {
            float value = channel_of(image, taps.texels[i], image->channels > 2 ? c : 0);
            sum.raw[c] += taps.weights[i] * (image->linear ? value : tl_srgb_to_linear(value));
        }
    return sum;
}

bool tl_cutout_at(const tl_material *material, vec2s uv)
{
    const struct tl_map *map = &material->diffuse_map;
    float alpha = has_alpha(map->image) ? bilinear_alpha(map, uv) : 1;
    return material->alpha_cutoff > 0 && alpha < material->alpha_cutoff;
}
