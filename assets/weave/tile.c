#include "assets/weave/tile.h"

#include "config/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

struct tl_tile tl_tile_make(int width, int height, double width_m, double height_m, float base_m)
{
    const size_t count = (size_t)width * (size_t)height;
    assert(width >= TL_TILE_SIDE_MIN && height >= TL_TILE_SIDE_MIN);
    struct tl_tile tile = {.width = width, .height = height, .size_m = {width_m, height_m}};
    tile.heights = TL_NEW_ARRAY(float, count);
    tile.tints = TL_NEW_ARRAY(float, 3 * count);
    for (size_t i = 0; i < count; i++)
        tile.heights[i] = base_m;
    for (size_t i = 0; i < 3 * count; i++)
        tile.tints[i] = 1;
    return tile;
}

void tl_tile_release(struct tl_tile *tile)
{
    free(tile->heights);
    free(tile->tints);
    free(tile->leans);
    *tile = (struct tl_tile){0};
}

/* The finaliser of SplitMix64. */
double tl_tile_random(uint32_t seed, int64_t i, int64_t j)
{
    uint64_t x = (uint64_t)seed * 0x9e3779b97f4a7c15u + (uint64_t)i * 0xbf58476d1ce4e5b9u +
                 (uint64_t)j * 0x94d049bb133111ebu;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    x ^= x >> 31;
    return (double)(x >> 11) * 0x1p-53;
}

static int wrapped(int i, int count)
{
    i %= count;
    return i < 0 ? i + count : i;
}

/* Wraps an index less than a period away. */
static int near(int i, int count)
{
    return i < 0 ? i + count : i >= count ? i - count : i;
}

double tl_tile_noise(uint32_t seed, double x, int period)
{
    double first = floor(x), t = x - first, smooth = t * t * (3 - 2 * t);
    double a = tl_tile_random(seed, wrapped((int)first, period), period);
    double b = tl_tile_random(seed, wrapped((int)first + 1, period), period);
    return 2 * (a + (b - a) * smooth) - 1;
}

/* Height of a twist over its yarn, as a share of the diameter [LOOK: by eye]. */
#define PLY_DEPTH 0.08

double tl_tile_fibres(uint32_t seed, double across, double run, double ply_m, double melange)
{
    const double fibre_m = 2.5e-3, lanes = 5;
    if (!(melange > 0))
        return 1;
    double turn = ply_m > 0 ? run / ply_m : 0;
    double lane = floor(lanes * (across + 2 * turn));
    double length = floor(run / fibre_m + 7 * tl_tile_random(seed, (int64_t)lane, -1));
    return 1 + melange * (2 * tl_tile_random(seed, (int64_t)lane, (int64_t)length) - 1);
}

void tl_tile_lay(struct tl_tile *tile, const struct tl_strand *strand)
{
    const double texel_x = tile->size_m[0] / tile->width, texel_y = tile->size_m[1] / tile->height;
    const double r = strand->radius;
    const int left = (int)ceil((strand->x - r) / texel_x - 0.5),
              right = (int)floor((strand->x + r) / texel_x - 0.5);
    const int low = (int)ceil((strand->y - r) / texel_y - 0.5),
              high = (int)floor((strand->y + r) / texel_y - 0.5);
    for (int j = low; j <= high; j++) {
        const size_t row = (size_t)(tile->height - 1 - wrapped(j, tile->height)) * (size_t)tile->width;
        for (int i = left, column = wrapped(left, tile->width); i <= right;
             i++, column = near(column + 1, tile->width)) {
            double dx = ((i + 0.5) * texel_x - strand->x) / r, dy = ((j + 0.5) * texel_y - strand->y) / r;
            double rest = 1 - dx * dx - dy * dy;
            if (rest <= 0)
                continue;
            double across = dy * strand->along_x - dx * strand->along_y, rise = sqrt(rest);
            double height = strand->z + r * rise;
            if (strand->ply_m > 0)
                height +=
                    PLY_DEPTH * 2 * r * rise * cos(2 * M_PI * (strand->run / strand->ply_m + across / 2));
            const size_t texel = row + (size_t)column;
            if (height > (double)tile->heights[texel]) {
                tile->heights[texel] = (float)height;
                const float shade =
                    (float)tl_tile_fibres(strand->seed, across, strand->run, strand->ply_m, strand->melange);
                for (size_t c = 0; c < 3; c++)
                    tile->tints[3 * texel + c] = strand->tint[c] * shade;
            }
        }
    }
}

static float height_at(const struct tl_tile *tile, int column, int row)
{
    return tile
        ->heights[(size_t)near(row, tile->height) * (size_t)tile->width + (size_t)near(column, tile->width)];
}

/* Means over `width` of `count` values that lie `stride` apart and repeat, by a running sum. */
static void blur_line(const float *from, float *to, int count, size_t stride, int width)
{
    double sum = 0;
    for (int i = 0; i < width; i++)
        sum += (double)from[(size_t)near(i - width / 2 - 1, count) * stride];
    for (int i = 0; i < count; i++) {
        sum += (double)from[(size_t)near(i + width - width / 2 - 1, count) * stride] -
               (double)from[(size_t)near(i - width / 2 - 1, count) * stride];
        to[(size_t)i * stride] = (float)(sum / width);
    }
}

/* The mean about each texel, twice over a fifth of the tile, so that hardly any wave of that length is left.
 */
static float *blurred(const struct tl_tile *tile, const float *values, size_t channels)
{
    const size_t row = channels * (size_t)tile->width, count = row * (size_t)tile->height;
    float *a = TL_NEW_ARRAY(float, count), *b = TL_NEW_ARRAY(float, count);
    for (int pass = 0; pass < 2; pass++) {
        const float *from = pass == 0 ? values : b;
        for (size_t y = 0; y < (size_t)tile->height; y++)
            for (size_t c = 0; c < channels; c++)
                blur_line(from + y * row + c, a + y * row + c, tile->width, channels, tile->width / 5);
        for (size_t x = 0; x < row; x++)
            blur_line(a + x, b + x, tile->height, row, tile->height / 5);
    }
    free(a);
    return b;
}

void tl_tile_even_heights(struct tl_tile *tile)
{
    float *means = blurred(tile, tile->heights, 1);
    for (size_t i = 0; i < (size_t)tile->width * (size_t)tile->height; i++)
        tile->heights[i] -= means[i];
    free(means);
}

void tl_tile_even_tints(struct tl_tile *tile)
{
    const size_t count = 3 * (size_t)tile->width * (size_t)tile->height;
    float *means = blurred(tile, tile->tints, 3);
    double sums[3] = {0};
    for (size_t i = 0; i < count; i++)
        sums[i % 3] += (double)tile->tints[i];
    for (size_t i = 0; i < count; i++)
        tile->tints[i] *= means[i] > 0 ? (float)(3 * sums[i % 3] / (double)count) / means[i] : 1;
    free(means);
}

#define DIRECTIONS 8
#define STEPS      9

/* The share of a uniform sky that is seen over the horizon: the mean of 1 - sin^2 over the azimuths. Steps
 * grow, so that they reach far: 1, 2, 3, 4, 6, 8, 11, 15, 20 texels. */
static float sky_at(const struct tl_tile *tile, int column, int row)
{
    static const int steps[STEPS] = {1, 2, 3, 4, 6, 8, 11, 15, 20};
    static const int ways[DIRECTIONS][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                            {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    const float texel_x = (float)tile->size_m[0] / (float)tile->width;
    const float texel_y = (float)tile->size_m[1] / (float)tile->height;
    const float here = height_at(tile, column, row);
    float seen = 0;
    for (int k = 0; k < DIRECTIONS; k++) {
        float steepest = 0;
        const float distance = hypotf(texel_x * (float)ways[k][0], texel_y * (float)ways[k][1]);
        for (int s = 0; s < STEPS; s++) {
            float rise = height_at(tile, column + ways[k][0] * steps[s], row + ways[k][1] * steps[s]) - here;
            steepest = fmaxf(steepest, rise / (distance * (float)steps[s]));
        }
        seen += 1 / (1 + steepest * steepest); /* cos^2 of the elevation */
    }
    return seen / DIRECTIONS;
}

void tl_tile_shade(struct tl_tile *tile, float share)
{
    const float inside =
        0.25f; /* of the light that a valley's walls send back stays in it and comes out later */
    const size_t count = (size_t)tile->width * (size_t)tile->height;
    float *open = TL_NEW_ARRAY(float, count);
    double before = 0;
    for (size_t i = 0; i < 3 * count; i++)
        before += (double)tile->tints[i];
#pragma omp parallel for schedule(static)
    for (int row = 0; row < tile->height; row++)
        for (int column = 0; column < tile->width; column++) {
            float sky = sky_at(tile, column, row);
            open[(size_t)row * (size_t)tile->width + (size_t)column] = sky / (1 - inside * (1 - sky));
        }
    double sum = 0;
    for (size_t i = 0; i < 3 * count; i++) {
        tile->tints[i] *= 1 + share * (open[i / 3] - 1);
        sum += (double)tile->tints[i];
    }
    const float scale = (float)(before / sum);
    for (size_t i = 0; i < 3 * count; i++)
        tile->tints[i] *= scale;
    free(open);
}

static uint8_t encode(float component)
{
    return (uint8_t)lroundf(255 * (0.5f + 0.5f * component));
}

/* A strand's edge over what lies below it is a step: its slope is bounded, for bytes hold no vertical normal.
 */
#define SLOPE_MAX 2.0f

static float bounded(float slope)
{
    return slope / sqrtf(1 + slope * slope / (SLOPE_MAX * SLOPE_MAX));
}

tl_weave tl_tile_weave(const struct tl_tile *tile)
{
    const size_t count = (size_t)tile->width * (size_t)tile->height;
    tl_weave weave = {.size_m = {(float)tile->size_m[0], (float)tile->size_m[1]},
                      .normal = tl_image_create(tile->width, tile->height, 3, TL_IMAGE_U8),
                      .height = tl_image_create(tile->width, tile->height, 1, TL_IMAGE_F32),
                      .gloss = tl_image_create(tile->width, tile->height, 1, TL_IMAGE_F32),
                      .tint = tl_image_create(tile->width, tile->height, 3, TL_IMAGE_F32)};
    const float texel_x = weave.size_m[0] / (float)tile->width,
                texel_y = weave.size_m[1] / (float)tile->height;
    double sum = 0;
    weave.normal.linear = true;
    for (size_t i = 0; i < count; i++)
        sum += (double)tile->heights[i];
    for (size_t i = 0; i < count; i++) {
        const int column = (int)(i % (size_t)tile->width), row = (int)(i / (size_t)tile->width);
        float x =
            bounded((height_at(tile, column + 1, row) - height_at(tile, column - 1, row)) / (2 * texel_x));
        float y =
            bounded((height_at(tile, column, row - 1) - height_at(tile, column, row + 1)) / (2 * texel_y));
        if (tile->leans) {
            x += tile->leans[2 * i];
            y += tile->leans[2 * i + 1];
        }
        float scale = 1 / sqrtf(1 + x * x + y * y);
        uint8_t *normal = tl_image_bytes(&weave.normal) + 3 * i;
        normal[0] = encode(-x * scale);
        normal[1] = encode(-y * scale);
        normal[2] = encode(scale);
        tl_image_floats(&weave.height)[i] = (float)((double)tile->heights[i] - sum / (double)count);
        tl_image_floats(&weave.gloss)[i] = 0;
        for (size_t c = 0; c < 3; c++)
            tl_image_floats(&weave.tint)[3 * i + c] = tile->tints[3 * i + c];
    }
    return weave;
}
