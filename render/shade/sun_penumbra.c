#include "render/shade/sun_penumbra_internal.h"

#include "render/shade/sun_bundle_internal.h"

#include <string.h>

#define ROWS  16 /* that a thread takes at a time */
#define MORE  8  /* rays for a pixel in a penumbra */
#define CHUNK 64 /* pixels whose rays are gathered together */
#define FAINT 5  /* times the contrast that is softened: less than that takes half of the rays */
/* Neighbours of a pixel that sees a part of the sun are looked at, too, so far away each way and so often: of
 * a penumbra at most REACH * GROWTHS pixels to either side of the shadow's edge are found. */
#define REACH   1
#define GROWTHS 24

/* ---- Pixels beside the edge of a shadow ---- */

static uint8_t lesser(uint8_t a, uint8_t b)
{
    return a < b ? a : b;
}

static uint8_t greater(uint8_t a, uint8_t b)
{
    return a > b ? a : b;
}

/* The least and the most that is seen in the rows about row y by what faces the sun. */
TL_CLONES static void join_rows(const uint8_t *states, int width, int height, int y,
                                uint8_t *restrict minimum, uint8_t *restrict maximum)
{
    const uint8_t *row = states + (size_t)y * (size_t)width;
    const uint8_t *below = y > 0 ? row - width : row, *above = y + 1 < height ? row + width : row;
    for (int x = 0; x < width; x++) {
        /* Others count as the greatest number among the least: they wrap. */
        uint8_t a = (uint8_t)(below[x] - TL_SUN_FACED), b = (uint8_t)(row[x] - TL_SUN_FACED),
                c = (uint8_t)(above[x] - TL_SUN_FACED);
        minimum[x] = lesser(lesser(a, b), c);
        maximum[x] = greater(greater(below[x], row[x]), above[x]);
    }
}

/* Marks the pixels of a row that face the sun where the 3 x 3 about them see shares of it that differ by more
 * than `contrast`. `minimum` and `maximum` go on for a pixel before and after the row. */
TL_CLONES static void mark_edges(const uint8_t *states, const uint8_t *minimum, const uint8_t *maximum,
                                 int width, float contrast, uint8_t *restrict marks)
{
    const int limit = (int)(contrast * (TL_SUN_STEPS * TL_SUN_STEPS));
    for (int x = 0; x < width; x++) {
        const uint8_t low = lesser(lesser(minimum[x - 1], minimum[x]), minimum[x + 1]);
        const uint8_t high =
            (uint8_t)(greater(greater(maximum[x - 1], maximum[x]), maximum[x + 1]) - TL_SUN_FACED);
        marks[x] = (uint8_t)(states[x] >= TL_SUN_FACED) & (uint8_t)(high * high - low * low > limit);
    }
}

static void show_row(const uint8_t *states, int width, float *visible)
{
    for (int x = 0; x < width; x++)
        visible[x] = tl_sun_share_of(states[x]);
}

/* Shows some rows without penumbrae, and lists their pixels that lie beside an edge. Returns how many. */
static size_t list_edges(const struct tl_sun_pixels *pixels, int width, int height, int first_row,
                         int end_row, float *visible, uint32_t *list)
{
    size_t count = 0;
    for (int y = first_row; y < end_row; y++) {
        const size_t row = (size_t)y * (size_t)width;
        uint8_t *minimum = pixels->minimum + row + 2 * (size_t)y + 1,
                *maximum = pixels->maximum + row + 2 * (size_t)y + 1, *marks = pixels->marks + row;
        show_row(pixels->states + row, width, visible + row);
        join_rows(pixels->states, width, height, y, minimum, maximum);
        minimum[-1] = minimum[width] = UINT8_MAX;
        maximum[-1] = maximum[width] = 0;
        mark_edges(pixels->states + row, minimum, maximum, width, pixels->contrast, marks);
        for (const uint8_t *at = marks; (at = memchr(at, 1, (size_t)(marks + width - at))) != NULL; at++)
            list[count++] = (uint32_t)(row + (size_t)(at - marks));
    }
    return count;
}

/* Lists all of them, in order. */
static size_t begin_list(const struct tl_sun_pixels *pixels, int width, int height, float *visible)
{
    size_t *counts = pixels->block_counts, count = 0;
#pragma omp parallel for schedule(dynamic)
    for (int y = 0; y < height; y += ROWS)
        counts[y / ROWS] = list_edges(pixels, width, height, y, y + ROWS < height ? y + ROWS : height,
                                      visible, pixels->pixels + (size_t)y * (size_t)width);
    for (int y = 0; y < height; y += ROWS) {
        memmove(pixels->pixels + count, pixels->pixels + (size_t)y * (size_t)width,
                counts[y / ROWS] * sizeof *pixels->pixels);
        count += counts[y / ROWS];
    }
    for (size_t i = 0; i < count; i++)
        pixels->states[pixels->pixels[i]] |= TL_SUN_LISTED;
    return count;
}

/* Appends the neighbours of listed pixels first .. count - 1 that see a part of the sun. Returns the new
 * number. */
static size_t grow_list(const struct tl_sun_pixels *pixels, int width, int height, size_t first, size_t count)
{
    size_t end = count;
    for (size_t i = first; i < count; i++) {
        if (!pixels->is_partial[i])
            continue;
        const int x = (int)(pixels->pixels[i] % (uint32_t)width),
                  y = (int)(pixels->pixels[i] / (uint32_t)width);
        for (int row = y - REACH; row <= y + REACH; row++)
            for (int column = x - REACH; column <= x + REACH; column++) {
                if (row < 0 || row >= height || column < 0 || column >= width)
                    continue;
                const size_t pixel = (size_t)row * (size_t)width + (size_t)column;
                if (!tl_sun_is_faced(pixels->states[pixel]))
                    continue;
                pixels->states[pixel] |= TL_SUN_LISTED;
                pixels->pixels[end++] = (uint32_t)pixel;
            }
    }
    return end;
}

/* ---- Their rays ---- */

/* Some pixels, with the origins of their rays and what they see. */
struct chunk {
    int count;
    uint32_t pixels[CHUNK];
    vec3s starts[CHUNK];
    float sums[CHUNK];
    float first[CHUNK];     /* by the first ray */
    float spans[CHUNK];     /* the greatest difference of a later one from it */
    bool is_settled[CHUNK]; /* no more rays */
};

static void add_seen(struct tl_sun_bundle *bundle, struct chunk *chunk)
{
    float seen[TL_SUN_BUNDLE];
    int count = tl_sun_bundle_trace(bundle, seen);
    for (int i = 0; i < count; i++) {
        const uint32_t k = bundle->pixels[i];
        chunk->sums[k] += seen[i];
        chunk->spans[k] = tl_maxf(chunk->spans[k], fabsf(seen[i] - chunk->first[k]));
    }
}

/* Adds what the pixels see of places [first, last] of the sun. */
static size_t look_at_places(struct chunk *chunk, const struct tl_sun_pixels_request *request,
                             const struct tl_sun *sun, int first, int last)
{
    size_t rays = 0;
    for (int k = first; k <= last; k++) {
        struct tl_pixel_light place = {.sun.direction = sun->samples[k]};
        struct tl_sun_bundle bundle = tl_sun_bundle_begin(request, &place);
        for (int i = 0; i < chunk->count; i++) {
            if (!chunk->is_settled[i])
                tl_sun_bundle_add(&bundle, (uint32_t)i, chunk->starts[i]);
            if (bundle.rays.count == TL_SUN_BUNDLE)
                add_seen(&bundle, chunk);
        }
        add_seen(&bundle, chunk);
        rays += bundle.count;
    }
    return rays;
}

/* Means over all rays of a pixel; where the first ones differ little there are no others. Listed pixels first
 * .. end
 * - 1. */
static size_t soften_chunk(const struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request,
                           int sun, float *visible, size_t first, size_t end)
{
    const struct tl_pixel_light *light = &request->lights->items[sun];
    const struct tl_sun *item = &light->sun;
    const struct tl_sun_bundle towards = tl_sun_bundle_begin(request, light);
    const int more = item->sample_count - 1 < MORE ? item->sample_count - 1 : MORE, half = more / 2;
    uint8_t *is_partial = pixels->is_partial + first;
    struct chunk chunk = {.count = (int)(end - first)};
    for (int i = 0; i < chunk.count; i++) {
        chunk.pixels[i] = pixels->pixels[first + (size_t)i];
        chunk.is_settled[i] = !tl_sun_start(&towards, chunk.pixels[i], &chunk.starts[i]);
        chunk.first[i] = tl_sun_share_of(pixels->states[chunk.pixels[i]]);
        visible[chunk.pixels[i]] = chunk.sums[i] = chunk.first[i];
    }
    size_t rays = look_at_places(&chunk, request, item, 1, half);
    for (int i = 0; i < chunk.count; i++) {
        is_partial[i] = !chunk.is_settled[i] && chunk.spans[i] > pixels->contrast;
        if (is_partial[i])
            visible[chunk.pixels[i]] = chunk.sums[i] / (float)(1 + half);
        chunk.is_settled[i] |= chunk.spans[i] < FAINT * pixels->contrast;
    }
    rays += look_at_places(&chunk, request, item, half + 1, more);
    for (int i = 0; i < chunk.count; i++)
        if (!chunk.is_settled[i])
            visible[chunk.pixels[i]] = chunk.sums[i] / (float)(1 + more);
    return rays;
}

size_t tl_sun_soften(const struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request, int sun,
                     float *visible)
{
    const int width = request->ids->width, height = request->ids->height;
    size_t first = 0, count = begin_list(pixels, width, height, visible), rays = 0;
    if (request->lights->items[sun].sun.sample_count < 2)
        return 0;
    for (int growth = 0; first < count; growth++) {
#pragma omp parallel for schedule(dynamic) reduction(+ : rays)
        for (size_t i = first; i < count; i += CHUNK)
            rays += soften_chunk(pixels, request, sun, visible, i, i + CHUNK < count ? i + CHUNK : count);
        const size_t end = growth < GROWTHS ? grow_list(pixels, width, height, first, count) : count;
        first = count;
        count = end;
    }
    return rays;
}
