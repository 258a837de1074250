#include "render/shade/texels.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Larger images are packed in words whatever they hold: in floats a map of 4096 texels a side has 358 MB. */
#define FLOAT_TEXELS ((size_t)512 * 512)

/* Channel `c` of texel `index` of a level, linear. */
static float value_of(const struct tl_map_texture *map, int level, size_t index, int c)
{
    const int channels = map->image->channels;
    if (map->colour && channels <= 2) /* grey; with alpha where there are two */
        c = c < 3 ? 0 : channels == 2 ? 1 : 3;
    if (c >= channels)
        return c == 3 ? 1 : 0;
    size_t at = index * (size_t)channels + (size_t)c;
    if (level > 0)
        /* cppcheck-suppress arrayIndexOutOfBoundsCond; level < map->level_count */
        return map->levels[level][at];
    if (map->image->type == TL_IMAGE_F32)
        return tl_image_floats(map->image)[at];
    bool alpha = c == 3 || (c == 1 && channels == 2);
    uint8_t byte = tl_image_bytes(map->image)[at];
    return alpha ? (float)byte / 255 : map->decode[byte];
}

static void pack_level(const struct tl_map_texture *map, int level, struct tl_texels *texels)
{
    size_t count = (size_t)map->widths[level] * (size_t)map->heights[level];
    texels->widths[level] = map->widths[level];
    texels->heights[level] = map->heights[level];
    texels->levels[level] = tl_alloc(4 * count, texels->is_float ? sizeof(float) : sizeof(uint16_t));
#pragma omp parallel for if (count > 4096)
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 4; c++) {
            float value = value_of(map, level, i, c);
            if (texels->is_float)
                ((float *)texels->levels[level])[4 * i + (size_t)c] = value;
            else
                ((uint16_t *)texels->levels[level])[4 * i + (size_t)c] =
                    (uint16_t)(tl_maxf(tl_minf((value - texels->base) / texels->step, 65535), 0) + 0.5f);
        }
}

/* Alpha and missing channels are 0 to 1. */
static void find_range(const tl_image *image, struct tl_texels *texels)
{
    float low = 0, high = 1;
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; image->type == TL_IMAGE_F32 && i < count; i++) {
        low = fminf(low, tl_image_floats(image)[i]);
        high = fmaxf(high, tl_image_floats(image)[i]);
    }
    texels->base = low;
    texels->step = (high - low) / 65535;
}

struct tl_texels tl_texels_make(const tl_image *image, bool colour)
{
    struct tl_map_texture map = tl_map_texture_make(image, colour);
    bool is_small = (size_t)image->width * (size_t)image->height <= FLOAT_TEXELS;
    struct tl_texels texels = {.level_count = map.level_count,
                               .is_float = image->type == TL_IMAGE_F32 && is_small};
    find_range(image, &texels);
    for (int level = 0; level < map.level_count; level++)
        pack_level(&map, level, &texels);
    tl_map_texture_release(&map);
    return texels;
}

void tl_texels_release(struct tl_texels *texels)
{
    for (int level = 0; level < texels->level_count; level++)
        free(texels->levels[level]);
    *texels = (struct tl_texels){0};
}

size_t tl_texels_bytes(const struct tl_texels *texels)
{
    size_t count = 0;
    for (int level = 0; level < texels->level_count; level++)
        count += (size_t)texels->widths[level] * (size_t)texels->heights[level];
    return 4 * count * (texels->is_float ? sizeof(float) : sizeof(uint16_t));
}
