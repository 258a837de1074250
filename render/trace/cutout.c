#include "render/trace/cutout.h"

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

static float alpha_of(const tl_image *image, int x, int y)
{
    int alpha = image->channels - 1;
    size_t at = ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels + (size_t)alpha;
    return image->type == TL_IMAGE_U8 ? (float)tl_image_bytes(image)[at] / 255 : tl_image_floats(image)[at];
}

static bool has_alpha(const tl_image *image)
{
    return image && (image->channels == 2 || image->channels == 4);
}

static float bilinear_alpha(const struct tl_map *map, vec2s uv)
{
    const tl_image *image = map->image;
    vec2s at = tl_uv_transformed(&map->transform, uv);
    float x = at.x * (float)image->width - 0.5f, y = at.y * (float)image->height - 0.5f;
    if (!isfinite(x) || !isfinite(y))
        return 1;
    float left = floorf(x), top = floorf(y), across = x - left, down = y - top;
    int x0 = wrap(left, image->width, map->clamp_u), x1 = wrap(left + 1, image->width, map->clamp_u);
    int y0 = wrap(top, image->height, map->clamp_v), y1 = wrap(top + 1, image->height, map->clamp_v);
    float upper = (1 - across) * alpha_of(image, x0, y0) + across * alpha_of(image, x1, y0);
    float lower = (1 - across) * alpha_of(image, x0, y1) + across * alpha_of(image, x1, y1);
    return (1 - down) * upper + down * lower;
}

bool tl_cutout_at(const tl_material *material, vec2s uv)
{
    const struct tl_map *map = &material->diffuse_map;
    float alpha = has_alpha(map->image) ? bilinear_alpha(map, uv) : 1;
    return material->alpha_cutoff > 0 && alpha < material->alpha_cutoff;
}
