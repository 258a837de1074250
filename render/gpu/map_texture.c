#include "render/gpu/map_texture.h"

#include "config/base/memory.h"
#include "config/colour/srgb.h"

#include <math.h>
#include <stdlib.h>

static float decoded(const struct tl_map_texture *texture, size_t index, int channel)
{
    const tl_image *image = texture->image;
    if (image->type == TL_IMAGE_F32)
        return tl_image_floats(image)[index];
    bool alpha = channel == 3 || (channel == 1 && image->channels == 2);
    uint8_t value = tl_image_bytes(image)[index];
    return alpha ? (float)value / 255 : texture->decode[value];
}

static float value_at(const struct tl_map_texture *texture, int level, int x, int y, int channel)
{
    size_t row = (size_t)y * (size_t)texture->widths[level];
    size_t index = (row + (size_t)x) * (size_t)texture->image->channels + (size_t)channel;
    return level == 0 ? decoded(texture, index, channel) : texture->levels[level][index];
}

/* The texels of the finer level under a texel: two, or up to three where a side is odd. */
struct texel_span {
    int first, count;
    float shares[4];
};

static struct texel_span span_of(int index, int fine, int coarse)
{
    double ratio = (double)fine / coarse, from = index * ratio, to = from + ratio;
    struct texel_span span = {.first = (int)from};
    for (int i = span.first; i < fine && i < to && span.count < 4; i++)
        span.shares[span.count++] = (float)((fmin(to, i + 1) - fmax(from, i)) / ratio);
    return span;
}

/* A row of a level, weighted, to `sums` [width][channels]. */
static void add_row(const struct tl_map_texture *texture, int level, int y, float share, float *sums)
{
    int channels = texture->image->channels;
    for (int x = 0; x < texture->widths[level]; x++)
        for (int c = 0; c < channels; c++)
            sums[x * channels + c] += share * value_at(texture, level, x, y, c);
}

/* `fine` [widths[level - 1]][channels] is the mean of the rows that this row lies over. */
static void average_row(const struct tl_map_texture *texture, int level, const float *fine, float *to)
{
    int channels = texture->image->channels;
    for (int column = 0; column < texture->widths[level]; column++) {
        struct texel_span x = span_of(column, texture->widths[level - 1], texture->widths[level]);
        for (int i = 0; i < x.count; i++)
            for (int c = 0; c < channels; c++)
                to[column * channels + c] += x.shares[i] * fine[(x.first + i) * channels + c];
    }
}

static void average_level(struct tl_map_texture *texture, int level)
{
    size_t channels = (size_t)texture->image->channels, width = (size_t)texture->widths[level] * channels;
    size_t fine_width = (size_t)texture->widths[level - 1] * channels;
    int height = texture->heights[level];
    float *to = TL_NEW_ARRAY(float, width *(size_t)height);
#pragma omp parallel for if (height > 64)
    for (int row = 0; row < height; row++) {
        struct texel_span y = span_of(row, texture->heights[level - 1], height);
        float *fine = TL_NEW_ARRAY(float, fine_width);
        for (int j = 0; j < y.count; j++)
            add_row(texture, level - 1, y.first + j, y.shares[j], fine);
        average_row(texture, level, fine, &to[width * (size_t)row]);
        free(fine);
    }
    texture->levels[level] = to;
}

struct tl_map_texture tl_map_texture_make(const tl_image *image, bool colour)
{
    struct tl_map_texture texture = {.image = image, .colour = colour, .level_count = 1};
    for (int i = 0; i < 256; i++)
        texture.decode[i] = colour && !image->linear ? tl_srgb_to_linear((float)i / 255) : (float)i / 255;
    texture.widths[0] = image->width;
    texture.heights[0] = image->height;
    while (texture.level_count < TL_TEXTURE_LEVELS_MAX &&
           (texture.widths[texture.level_count - 1] > 1 || texture.heights[texture.level_count - 1] > 1)) {
        int level = texture.level_count++;
        texture.widths[level] = texture.widths[level - 1] / 2 > 1 ? texture.widths[level - 1] / 2 : 1;
        texture.heights[level] = texture.heights[level - 1] / 2 > 1 ? texture.heights[level - 1] / 2 : 1;
        average_level(&texture, level);
    }
    return texture;
}

void tl_map_texture_release(struct tl_map_texture *texture)
{
    for (int i = 0; i < texture->level_count; i++)
        free(texture->levels[i]);
    *texture = (struct tl_map_texture){0};
}

/* Index of the texel at whole number `at`, outside of the map as GL wraps it. */
static int wrap(float at, int size, bool clamp)
{
    if (clamp)
        return (int)fminf(fmaxf(at, 0), (float)(size - 1));
    int index = (int)(at - floorf(at / (float)size) * (float)size);
    return index < 0 ? 0 : index >= size ? size - 1 : index;
}

static vec4s texel_at(const struct tl_map_texture *texture, int level, int x, int y)
{
    int channels = texture->image->channels;
    vec4s texel = {{0, 0, 0, 1}};
    for (int c = 0; c < channels; c++)
        texel.raw[c] = value_at(texture, level, x, y, c);
    if (texture->colour && channels <= 2)
        texel = (vec4s){{texel.x, texel.x, texel.x, channels == 2 ? texel.y : 1}};
    return texel;
}

static vec4s bilinear(const struct tl_map_texture *texture, int level, vec2s uv, bool clamp_u, bool clamp_v)
{
    int width = texture->widths[level], height = texture->heights[level];
    float x = uv.x * (float)width - 0.5f, y = uv.y * (float)height - 0.5f;
    float left = floorf(x), top = floorf(y);
    vec4s sum = {{0, 0, 0, 0}};
    for (int i = 0; i < 4; i++) {
        float column = left + (float)(i & 1), row = top + (float)(i >> 1);
        float weight = (1 - fabsf(column - x)) * (1 - fabsf(row - y));
        vec4s texel = texel_at(texture, level, wrap(column, width, clamp_u), wrap(row, height, clamp_v));
        sum = glms_vec4_add(sum, glms_vec4_scale(texel, weight));
    }
    return sum;
}

static float length_in_texels(vec2s step, const tl_image *image)
{
    return hypotf(step.x * (float)image->width, step.y * (float)image->height);
}

vec4s tl_map_texture_fetch(const struct tl_map_texture *texture, const struct tl_footprint *at, bool clamp_u,
                           bool clamp_v)
{
    if (!isfinite(at->uv.x) || !isfinite(at->uv.y))
        return texel_at(texture, texture->level_count - 1, 0, 0);
    float texels =
        fmaxf(length_in_texels(at->across, texture->image), length_in_texels(at->down, texture->image));
    float last = (float)(texture->level_count - 1);
    float level = isfinite(texels) ? fminf(fmaxf(log2f(fmaxf(texels, 1)), 0), last) : last;
    int fine = (int)level;
    vec4s value = bilinear(texture, fine, at->uv, clamp_u, clamp_v);
    if (level > (float)fine) {
        vec4s coarse = bilinear(texture, fine + 1, at->uv, clamp_u, clamp_v);
        value = glms_vec4_lerp(value, coarse, level - (float)fine);
    }
    return value;
}
