/* Maps of materials packed for quick trilinear fetches on the CPU: four channels a texel, linear, in floats,
 * or in 16 bits between the image's smallest and largest value where the image has bytes or is large.
 * Filtering and wrapping are GL's [OpenGL 4.5, 8.14]; the levels are those of map_texture.h. 16 bits lose at
 * most 1 / 131070 of their range.
 *
 * Lifetime: owns its texels; the image may go once they are made. Threads: pure once made. */
#ifndef TOILE_RENDER_SHADE_TEXELS_H
#define TOILE_RENDER_SHADE_TEXELS_H

#include "render/env/quad.h"
#include "render/gpu/map_texture.h"

#include <stdbool.h>

typedef uint16_t tl_quad_of_words __attribute__((vector_size(4 * sizeof(uint16_t)), aligned(2)));

struct tl_texels {
    int level_count;
    bool is_float;
    float base, step; /* of 16 bits: value = base + step * word */
    int widths[TL_TEXTURE_LEVELS_MAX], heights[TL_TEXTURE_LEVELS_MAX];
    void *levels[TL_TEXTURE_LEVELS_MAX]; /* [height][width][4], uint16_t or float */
};

/* Packs an image. `colour`: bytes are sRGB unless the image is marked linear; grey spreads over red, green
 * and blue. Missing channels are 0, alpha 1. */
struct tl_texels tl_texels_make(const tl_image *image, bool colour);
void tl_texels_release(struct tl_texels *texels);
size_t tl_texels_bytes(const struct tl_texels *texels);

/* Wraps texel coordinate `x` (texels, centres at whole numbers) to two neighbours and the share of the
 * second. */
TL_INLINE float tl_texels_wrap(float x, int size, bool clamp, int *first, int *second)
{
    if (clamp) {
        x = tl_maxf(tl_minf(x, (float)(size - 1)), 0);
        *first = (int)x;
        *second = *first + 1 < size ? *first + 1 : *first;
        return x - (float)*first;
    }
    x -= floorf(x / (float)size) * (float)size;
    int whole = (int)x;
    float share = x - (float)whole;
    whole = whole < size ? whole : 0; /* rounding */
    *first = whole;
    *second = whole + 1 < size ? whole + 1 : 0;
    return share;
}

TL_INLINE tl_quad tl_texels_at(const struct tl_texels *texels, int level, size_t index)
{
    if (texels->is_float)
        return ((const tl_quad *)texels->levels[level])[index];
    const tl_quad_of_words words = ((const tl_quad_of_words *)texels->levels[level])[index];
    return texels->base + texels->step * __builtin_convertvector(words, tl_quad);
}

TL_INLINE tl_quad tl_texels_bilinear(const struct tl_texels *texels, int level, float u, float v,
                                     bool clamp_u, bool clamp_v)
{
    const int width = texels->widths[level], height = texels->heights[level];
    int left, right, top, bottom;
    float x = tl_texels_wrap(u * (float)width - 0.5f, width, clamp_u, &left, &right);
    float y = tl_texels_wrap(v * (float)height - 0.5f, height, clamp_v, &top, &bottom);
    size_t upper = (size_t)top * (size_t)width, lower = (size_t)bottom * (size_t)width;
    tl_quad a = tl_texels_at(texels, level, upper + (size_t)left);
    tl_quad b = tl_texels_at(texels, level, upper + (size_t)right);
    tl_quad c = tl_texels_at(texels, level, lower + (size_t)left);
    tl_quad d = tl_texels_at(texels, level, lower + (size_t)right);
    a += x * (b - a);
    c += x * (d - c);
    return a + y * (c - a);
}

/* The mean of the map. */
TL_INLINE tl_quad tl_texels_mean(const struct tl_texels *texels)
{
    return tl_texels_at(texels, texels->level_count - 1, 0);
}

/* Fetches at (u, v), which must be finite, with `level` >= 0 the base-2 logarithm of the texels that lie
 * under a sample. */
TL_INLINE tl_quad tl_texels_fetch(const struct tl_texels *texels, float u, float v, float level, bool clamp_u,
                                  bool clamp_v)
{
    if (level >= (float)(texels->level_count - 1))
        return tl_texels_mean(texels);
    int fine = (int)level;
    tl_quad value = tl_texels_bilinear(texels, fine, u, v, clamp_u, clamp_v);
    float share = level - (float)fine;
    if (share > 0)
        value += share * (tl_texels_bilinear(texels, fine + 1, u, v, clamp_u, clamp_v) - value);
    return value;
}

#endif
