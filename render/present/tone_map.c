#include "render/present/tone_map.h"

#include "config/base/memory.h"
#include "config/base/simd.h"
#include "render/present/tone.h"

#include <stdlib.h>
#include <string.h>

#define STEP_BITS      13 /* of the mantissa's 23, that are less than a step */
#define SMALLEST       (1.0f / (1 << TL_ENCODING_OCTAVES))
#define SMALLEST_INDEX ((127 - TL_ENCODING_OCTAVES) * TL_ENCODING_STEPS)

_Static_assert(1 << (23 - STEP_BITS) == TL_ENCODING_STEPS, "the index is the upper part of a float");

enum { CODES = TL_ENCODING_OCTAVES * TL_ENCODING_STEPS }; /* of values below 1 */

void tl_encoding_make(struct tl_encoding *out)
{
    for (int i = 0; i < CODES; i++) {
        union tl_float_bits middle = {.bits = ((i + SMALLEST_INDEX) << STEP_BITS) + (1 << (STEP_BITS - 1))};
        out->bytes[i] = (uint8_t)(255.0f * srgb_encode(middle.value) + 0.5f);
    }
    out->bytes[CODES] = 255; /* of 1 */
}

/* A row of a tile. Loops of TL_LANES would be unrolled, and not become vector code. */
#define COLUMNS TL_BEHIND_COLUMNS
struct row {
    float red[COLUMNS], green[COLUMNS], blue[COLUMNS];
    float open[COLUMNS];
};

/* Returns whether the background is seen in any of them. */
TL_INLINE bool load(const float *texels, vec3s exposure, struct row *out)
{
    int32_t open = 0;
    for (size_t i = 0; i < COLUMNS; i++) {
        out->red[i] = exposure.r * texels[4 * i];
        out->green[i] = exposure.g * texels[4 * i + 1];
        out->blue[i] = exposure.b * texels[4 * i + 2];
        out->open[i] = 1.0f - tone_clamp(texels[4 * i + 3], 0.0f, 1.0f);
    }
    for (int i = 0; i < COLUMNS; i++)
        open |= out->open[i] > 0.0f;
    return open;
}

TL_INLINE void put_under(float channel[COLUMNS], const float open[COLUMNS], const float *behind,
                         float exposure)
{
    for (int i = 0; i < COLUMNS; i++)
        channel[i] += open[i] * (exposure * behind[i]);
}

TL_INLINE void put_plain_under(float channel[COLUMNS], const float open[COLUMNS], float plain)
{
    for (int i = 0; i < COLUMNS; i++)
        channel[i] += open[i] * plain;
}

TL_INLINE void compress(float channel[COLUMNS], const float peaks[COLUMNS])
{
    for (int i = 0; i < COLUMNS; i++)
        channel[i] = peaks[i] < TONE_START ? channel[i] : tone_compress(channel[i], peaks[i]);
}

TL_INLINE void map(struct row *row)
{
    float peaks[COLUMNS];
    int32_t is_bright = 0;
    for (int i = 0; i < COLUMNS; i++) {
        float red = tone_bound(row->red[i]), green = tone_bound(row->green[i]),
              blue = tone_bound(row->blue[i]);
        float offset = tone_offset(tl_minf(red, tl_minf(green, blue)));
        row->red[i] = red - offset;
        row->green[i] = green - offset;
        row->blue[i] = blue - offset;
        peaks[i] = tl_maxf(row->red[i], tl_maxf(row->green[i], row->blue[i]));
    }
    for (int i = 0; i < COLUMNS; i++)
        is_bright |= peaks[i] >= TONE_START;
    if (!is_bright)
        return;
    compress(row->red, peaks);
    compress(row->green, peaks);
    compress(row->blue, peaks);
}

TL_INLINE void find_codes(const float channel[COLUMNS], int32_t codes[COLUMNS])
{
    for (int i = 0; i < COLUMNS; i++) {
        union tl_float_bits bounded = {.value = tone_clamp(channel[i], SMALLEST, 1.0f)};
        codes[i] = (bounded.bits >> STEP_BITS) - SMALLEST_INDEX;
    }
}

TL_INLINE void encode(const struct tl_encoding *encoding, const struct row *row, uint8_t *bytes)
{
    int32_t red[COLUMNS], green[COLUMNS], blue[COLUMNS];
    find_codes(row->red, red);
    find_codes(row->green, green);
    find_codes(row->blue, blue);
    for (size_t i = 0; i < COLUMNS; i++) {
        bytes[4 * i] = encoding->bytes[red[i]];
        bytes[4 * i + 1] = encoding->bytes[green[i]];
        bytes[4 * i + 2] = encoding->bytes[blue[i]];
        bytes[4 * i + 3] = 255;
    }
}

/* The part of the image that a tile of tl_behind covers. */
struct tile {
    int column, row; /* of the tiles */
    int left, right, low, high;
};

static struct tile tile_at(const struct tl_tone_map_request *request, int column, int row)
{
    struct tile tile = {
        .column = column, .row = row, .left = column * TL_BEHIND_COLUMNS, .low = row * TL_BEHIND_ROWS};
    int right = tile.left + TL_BEHIND_COLUMNS, high = tile.low + TL_BEHIND_ROWS;
    tile.right = right < request->width ? right : request->width;
    tile.high = high < request->height ? high : request->height;
    return tile;
}

/* Shows a row of a tile. `first` is the number of its first pixel in the tile; `behind` is the tile's, NULL
 * until it is needed. */
TL_INLINE void show_row(const struct tl_tone_map_request *request, const struct tile *tile,
                        const float *texels, int first, const float **behind, uint8_t *bytes)
{
    struct row row;
    bool is_open = load(texels, request->is_light ? request->exposure : glms_vec3_one(), &row);
    if (is_open && request->behind) {
        if (!*behind)
            *behind = tl_behind_tile(request->behind, tile->column, tile->row);
        const float *colours = *behind + first;
        put_under(row.red, row.open, colours, request->exposure.r);
        put_under(row.green, row.open, colours + TL_BEHIND_PIXELS, request->exposure.g);
        put_under(row.blue, row.open, colours + (size_t)2 * TL_BEHIND_PIXELS, request->exposure.b);
    } else if (is_open) {
        float plain = request->is_light ? SHOWN_GREY : SHOWN_DARK;
        put_plain_under(row.red, row.open, plain);
        put_plain_under(row.green, row.open, plain);
        put_plain_under(row.blue, row.open, plain);
    }
    if (request->is_light)
        map(&row);
    encode(request->encoding, &row, bytes);
}

TL_CLONES static void show_tile(const struct tl_tone_map_request *request, const struct tile *tile,
                                uint8_t *bytes)
{
    const float *behind = NULL;
    size_t count = (size_t)(tile->right - tile->left);
    for (int y = tile->low; y < tile->high; y++) {
        size_t texel = (size_t)y * (size_t)request->width + (size_t)tile->left;
        const float *texels = request->texels + 4 * texel;
        float padded[4 * COLUMNS] = {0};
        uint8_t shown[4 * COLUMNS];
        if (count < COLUMNS)
            texels = memcpy(padded, texels, 4 * count * sizeof *padded);
        show_row(request, tile, texels, (y - tile->low) * COLUMNS, &behind, shown);
        memcpy(bytes + 4 * texel, shown, 4 * count);
    }
}

void tl_tone_map(const struct tl_tone_map_request *request, uint8_t *bytes)
{
    int first = request->first_column / TL_BEHIND_COLUMNS;
    int end = (request->end_column + TL_BEHIND_COLUMNS - 1) / TL_BEHIND_COLUMNS;
    int rows = (request->height + TL_BEHIND_ROWS - 1) / TL_BEHIND_ROWS;
#pragma omp parallel for schedule(dynamic, 4)
    for (int row = 0; row < rows; row++)
        for (int column = first; column < end; column++) {
            const struct tile tile = tile_at(request, column, row);
            show_tile(request, &tile, bytes);
        }
}

tl_image tl_tone_map_image(const tl_image *light, vec3s exposure)
{
    tl_image out = tl_image_create(light->width, light->height, 4, TL_IMAGE_U8);
    struct tl_encoding *encoding = TL_NEW(struct tl_encoding);
    tl_encoding_make(encoding);
    tl_tone_map(&(const struct tl_tone_map_request){.encoding = encoding,
                                                    .texels = tl_image_floats(light),
                                                    .width = light->width,
                                                    .height = light->height,
                                                    .end_column = light->width,
                                                    .is_light = true,
                                                    .exposure = exposure},
                tl_image_bytes(&out));
    free(encoding);
    return out;
}
