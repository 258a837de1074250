#include "render/shade/sun_pixels.h"

#include "config/base/memory.h"
#include "render/shade/sun_bundle_internal.h"
#include "render/shade/sun_penumbra_internal.h"

#include <stdlib.h>
#include <string.h>

#define CELL         4     /* pixels a side */
#define GROUND_CELL  8     /* ... of those on the ground, whose corners are looked at first */
#define CELLS_A_TIME 16    /* of those that are traced late, by a thread */
#define CONTRAST     0.06f /* differences of the sun's share in a pixel that are softened */

static int cells_along(int size)
{
    return (size + CELL - 1) / CELL;
}

static void reserve(struct tl_sun_pixels *pixels, int width, int height, int layers, int suns)
{
    const size_t count = (size_t)width * (size_t)height;
    const size_t cells = (size_t)cells_along(width) * (size_t)cells_along(height);
    if (count > pixels->capacity || cells > pixels->cell_capacity) {
        tl_sun_pixels_release(pixels);
        pixels->capacity = count;
        pixels->cell_capacity = cells;
        pixels->states = TL_NEW_ARRAY(uint8_t, count);
        pixels->marks = TL_NEW_ARRAY(uint8_t, count);
        pixels->pixels = TL_NEW_ARRAY(uint32_t, count);
        pixels->is_partial = TL_NEW_ARRAY(uint8_t, count);
        pixels->cells = TL_NEW_ARRAY(uint8_t, cells);
        pixels->late = TL_NEW_ARRAY(uint32_t, cells);
    }
    if (height > pixels->row_capacity) {
        free(pixels->block_counts);
        free(pixels->minimum);
        free(pixels->maximum);
        pixels->row_capacity = height;
        pixels->minimum = TL_NEW_ARRAY(uint8_t, pixels->capacity + 2 * (size_t)height);
        pixels->maximum = TL_NEW_ARRAY(uint8_t, pixels->capacity + 2 * (size_t)height);
        pixels->block_counts = TL_NEW_ARRAY(size_t, (size_t)height);
    }
    for (int layer = 0; layer < layers; layer++)
        for (int i = 0; i < suns; i++)
            if (!pixels->visible[layer][i])
                pixels->visible[layer][i] = TL_NEW_ARRAY(float, pixels->capacity);
}

/* ---- Single pixels ---- */

static void mark_bundle(struct tl_sun_bundle *bundle, uint8_t *states)
{
    float seen[TL_SUN_BUNDLE];
    int count = tl_sun_bundle_trace(bundle, seen);
    for (int i = 0; i < count; i++)
        states[bundle->pixels[i]] = tl_sun_state_of(seen[i]);
}

/* Decides one pixel that nothing is known of, now or with its bundle. */
static void decide(struct tl_sun_bundle *bundle, uint32_t pixel, uint8_t *states)
{
    vec3s start;
    if (bundle->request->ids->ids[pixel] == 0) {
        states[pixel] = TL_SUN_EMPTY;
        return;
    }
    if (!tl_sun_start(bundle, pixel, &start)) {
        states[pixel] = TL_SUN_AWAY;
        return;
    }
    tl_sun_bundle_add(bundle, pixel, start);
    if (bundle->rays.count == TL_SUN_BUNDLE)
        mark_bundle(bundle, states);
}

/* ---- The grid ---- */

/* The IDs of a surface's triangles, of both sides. */
struct id_range {
    uint32_t first, count;
};

static bool is_of(struct id_range range, uint32_t id)
{
    return (id & ~TL_SAMPLE_BACK) - range.first < range.count; /* 0, which is nothing, wraps */
}

static struct id_range surface_of(const struct tl_triangle_ranges *ranges, uint32_t id)
{
    const uint32_t triangle = (id & ~TL_SAMPLE_BACK) - 1;
    size_t surface = 0;
    while (surface + 1 < ranges->surface_count && triangle >= ranges->first[surface + 1])
        surface++;
    return (struct id_range){(uint32_t)ranges->first[surface] + 1,
                             (uint32_t)(ranges->first[surface + 1] - ranges->first[surface])};
}

static bool is_ground(const struct tl_sun_pixels_request *request, struct id_range surface)
{
    const struct tl_triangle_ranges *ranges = request->ranges;
    return request->ground && surface.first == ranges->first[ranges->surface_count - 1] + 1;
}

/* The origin of the results of a cell's pixels; TRACED: by rays of their own, those of its surface at least.
 */
enum cell_state { FILLED, TRACED, BARE };

/* A cell of a grid: its corners' state where they agree, and their surface. */
struct cell {
    int x, y, end_x, end_y;
    bool is_one;
    uint8_t state;
    struct id_range surface;
};

/* The last cell of a row ends at the last pixel. */
static int next_line(int at, int size, int step)
{
    return at + step < size - 1 ? at + step : size - 1;
}

static struct cell cell_at(const struct tl_sun_pixels_request *request, const uint8_t *states, int x, int y,
                           int step)
{
    const uint32_t *ids = request->ids->ids;
    const int width = request->ids->width, height = request->ids->height;
    struct cell cell = {x, y, next_line(x, width, step), next_line(y, height, step), false, 0, {0, 0}};
    const size_t top = (size_t)y * (size_t)width, bottom = (size_t)cell.end_y * (size_t)width;
    const size_t corners[4] = {top + (size_t)x, top + (size_t)cell.end_x, bottom + (size_t)x,
                               bottom + (size_t)cell.end_x};
    cell.state = states[corners[0]];
    cell.is_one = tl_sun_is_faced(cell.state);
    if (!cell.is_one)
        return cell;
    cell.surface = surface_of(request->ranges, ids[corners[0]]);
    for (int i = 1; i < 4; i++)
        cell.is_one &= states[corners[i]] == cell.state && is_of(cell.surface, ids[corners[i]]);
    return cell;
}

/* Decides every pixel of a row at multiples of `step`, and the last one. */
static size_t trace_row(const struct tl_sun_pixels_request *request, const struct tl_pixel_light *light,
                        int y, int step, uint8_t *states)
{
    struct tl_sun_bundle bundle = tl_sun_bundle_begin(request, light);
    const int width = request->ids->width, cell_y = y - y % GROUND_CELL;
    const uint32_t row = (uint32_t)y * (uint32_t)width;
    struct cell cell = {.x = -1};
    for (int x = 0;; x = next_line(x, width, step)) {
        const uint32_t pixel = row + (uint32_t)x;
        const int cell_x = x - x % GROUND_CELL;
        if (step < GROUND_CELL && cell.x != cell_x)
            cell = cell_at(request, states, cell_x, cell_y, GROUND_CELL);
        if (states[pixel] == TL_SUN_UNKNOWN) {
            if (cell.is_one && is_ground(request, cell.surface) &&
                is_of(cell.surface, request->ids->ids[pixel]))
                states[pixel] = cell.state;
            else
                decide(&bundle, pixel, states);
        }
        if (x == width - 1)
            break;
    }
    mark_bundle(&bundle, states);
    return bundle.count;
}

/* First every eighth pixel each way, then every fourth where that is not clear; and the last ones. */
static size_t look_at_grid(const struct tl_sun_pixels_request *request, const struct tl_pixel_light *light,
                           uint8_t *states)
{
    size_t rays = 0;
    for (int step = GROUND_CELL; step >= CELL; step -= GROUND_CELL - CELL) {
        const int height = request->ids->height, lines = (height - 1 + step - 1) / step + 1;
#pragma omp parallel for schedule(dynamic, 4) reduction(+ : rays)
        for (int line = 0; line < lines; line++)
            rays += trace_row(request, light, line * step < height ? line * step : height - 1, step, states);
    }
    return rays;
}

/* The rest of a cell: pixels on the lines at its ends belong to the next cell, but at the picture's ends.
 */
static int last_of(int end, int size)
{
    return end < size - 1 ? end - 1 : end;
}

/* Whether all pixels that are left of a cell are of its surface; or, without one, whether none is covered. */
static bool is_whole(const struct tl_id_buffer *ids, const struct cell *cell)
{
    const struct id_range nothing = {0, 1}, range = cell->is_one ? cell->surface : nothing;
    const int last_x = last_of(cell->end_x, ids->width), last_y = last_of(cell->end_y, ids->height);
    bool all = true;
    for (int y = cell->y; y <= last_y; y++)
        for (int x = cell->x; x <= last_x; x++)
            all &= is_of(range, ids->ids[(size_t)y * (size_t)ids->width + (size_t)x]);
    return all;
}

/* Gives the pixels of a cell whose corners agree their answer where they are of the same surface, and decides
 * the others. */
static enum cell_state fill_cell(struct tl_sun_bundle *bundle, const struct cell *cell, uint8_t *states)
{
    const struct tl_id_buffer *ids = bundle->request->ids;
    const int last_x = last_of(cell->end_x, ids->width), last_y = last_of(cell->end_y, ids->height);
    if (is_whole(ids, cell)) {
        for (int y = cell->y; y <= last_y; y++)
            memset(states + (size_t)y * (size_t)ids->width + (size_t)cell->x,
                   cell->is_one ? cell->state : TL_SUN_EMPTY, (size_t)last_x - (size_t)cell->x + 1);
        return cell->is_one ? FILLED : BARE;
    }
    for (int y = cell->y; y <= last_y; y++)
        for (int x = cell->x; x <= last_x; x++) {
            const size_t pixel = (size_t)y * (size_t)ids->width + (size_t)x;
            if (states[pixel] != TL_SUN_UNKNOWN)
                continue;
            if (cell->is_one && is_of(cell->surface, ids->ids[pixel]))
                states[pixel] = cell->state;
            else
                decide(bundle, (uint32_t)pixel, states);
        }
    return cell->is_one ? FILLED : TRACED;
}

static size_t fill_cells(const struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request,
                         const struct tl_pixel_light *light)
{
    const int width = request->ids->width, height = request->ids->height, columns = cells_along(width);
    size_t rays = 0;
#pragma omp parallel for schedule(dynamic, 4) reduction(+ : rays)
    for (int y = 0; y < height; y += CELL) {
        struct tl_sun_bundle bundle = tl_sun_bundle_begin(request, light);
        uint8_t *cells = pixels->cells + (size_t)(y / CELL) * (size_t)columns;
        if (y + CELL < pixels->first_row || y >= pixels->end_row) {
            memset(cells, BARE, (size_t)columns);
            continue;
        }
        for (int x = 0; x < width; x += CELL) {
            struct cell cell = cell_at(request, pixels->states, x, y, CELL);
            cells[x / CELL] = (uint8_t)fill_cell(&bundle, &cell, pixels->states);
        }
        mark_bundle(&bundle, pixels->states);
        rays += bundle.count;
    }
    return rays;
}

/* ---- Cells beside what their corners missed ---- */

/* Whether a filled cell has a neighbour of its surface in another state. */
static bool is_doubtful(const struct tl_sun_pixels_request *request, const uint8_t *states,
                        const struct cell *cell)
{
    const struct tl_id_buffer *ids = request->ids;
    for (int y = cell->y - 1; y <= cell->end_y; y++)
        for (int x = cell->x - 1; x <= cell->end_x; x++) {
            if (x < 0 || x >= ids->width || y < 0 || y >= ids->height)
                continue;
            const size_t pixel = (size_t)y * (size_t)ids->width + (size_t)x;
            if (tl_sun_is_faced(states[pixel]) && states[pixel] != cell->state &&
                is_of(cell->surface, ids->ids[pixel]))
                return true;
        }
    return false;
}

/* Lists the filled cells about a traced one that are doubtful, and counts them as traced from now on. */
static size_t list_doubtful(const struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request,
                            size_t traced, size_t count)
{
    const int width = request->ids->width, columns = cells_along(width),
              rows = cells_along(request->ids->height);
    const int column = (int)(traced % (size_t)columns), row = (int)(traced / (size_t)columns);
    for (int j = row > 0 ? row - 1 : 0; j <= row + 1 && j < rows; j++)
        for (int i = column > 0 ? column - 1 : 0; i <= column + 1 && i < columns; i++) {
            const size_t index = (size_t)j * (size_t)columns + (size_t)i;
            if (pixels->cells[index] != FILLED)
                continue;
            const struct cell cell = cell_at(request, pixels->states, i * CELL, j * CELL, CELL);
            if (!is_doubtful(request, pixels->states, &cell))
                continue;
            pixels->cells[index] = TRACED;
            pixels->late[count++] = (uint32_t)index;
        }
    return count;
}

/* Traces a cell that was filled. */
static void trace_cell(struct tl_sun_bundle *bundle, int x, int y, uint8_t *states)
{
    const struct tl_id_buffer *ids = bundle->request->ids;
    const int last_x = last_of(next_line(x, ids->width, CELL), ids->width),
              last_y = last_of(next_line(y, ids->height, CELL), ids->height);
    for (int j = y; j <= last_y; j++)
        for (int i = x; i <= last_x; i++)
            if (tl_sun_is_faced(states[(size_t)j * (size_t)ids->width + (size_t)i]))
                decide(bundle, (uint32_t)j * (uint32_t)ids->width + (uint32_t)i, states);
}

/* A narrow shadow that some cells found is followed through those that its pixels lie within. */
static size_t follow_shadows(const struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request,
                             const struct tl_pixel_light *light)
{
    const size_t columns = (size_t)cells_along(request->ids->width),
                 cells = columns * (size_t)cells_along(request->ids->height);
    size_t rays = 0, first = 0, count = 0;
    for (size_t i = 0; i < cells; i++)
        if (pixels->cells[i] == TRACED)
            count = list_doubtful(pixels, request, i, count);
    while (first < count) {
#pragma omp parallel for schedule(dynamic) reduction(+ : rays)
        for (size_t i = first; i < count; i += CELLS_A_TIME) {
            struct tl_sun_bundle bundle = tl_sun_bundle_begin(request, light);
            for (size_t k = i; k < i + CELLS_A_TIME && k < count; k++)
                trace_cell(&bundle, (int)(pixels->late[k] % columns) * CELL,
                           (int)(pixels->late[k] / columns) * CELL, pixels->states);
            mark_bundle(&bundle, pixels->states);
            rays += bundle.count;
        }
        size_t end = count;
        for (size_t i = first; i < count; i++)
            end = list_doubtful(pixels, request, pixels->late[i], end);
        first = count;
        count = end;
    }
    return rays;
}

static void find_rows(struct tl_sun_pixels *pixels, const struct tl_id_buffer *ids, int layer)
{
    pixels->first_row = 0;
    pixels->end_row = ids->height;
    while (layer > 0 && pixels->first_row < pixels->end_row && ids->depths[pixels->first_row] < layer)
        pixels->first_row++;
    while (layer > 0 && pixels->first_row < pixels->end_row && ids->depths[pixels->end_row - 1] < layer)
        pixels->end_row--;
}

/* State of one layer. */
static void trace_sun(struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request, int sun,
                      float *visible)
{
    struct tl_pixel_light light = request->lights->items[sun];
    if (light.sun.sample_count > 0)
        light.sun.direction = light.sun.samples[0];
    memset(pixels->states, TL_SUN_UNKNOWN, (size_t)request->ids->width * (size_t)request->ids->height);
    pixels->rays += look_at_grid(request, &light, pixels->states);
    pixels->rays += fill_cells(pixels, request, &light);
    pixels->rays += follow_shadows(pixels, request, &light);
    pixels->rays += tl_sun_soften(pixels, request, sun, visible);
}

void tl_sun_pixels_update(struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request)
{
    const struct tl_id_buffer *ids = request->ids;
    reserve(pixels, ids->width, ids->height, ids->layer_count, request->lights->count);
    pixels->rays = 0;
    float weight = 1;
    for (int layer = 0; layer < ids->layer_count; layer++, weight *= request->openness) {
        const struct tl_id_buffer ids_of_layer = tl_ids_layer(ids, layer);
        struct tl_sun_pixels_request of_layer = *request;
        of_layer.ids = &ids_of_layer;
        find_rows(pixels, ids, layer);
        pixels->contrast = CONTRAST / weight;
        for (int sun = 0; sun < request->lights->count; sun++)
            trace_sun(pixels, &of_layer, sun, pixels->visible[layer][sun]);
    }
}

void tl_sun_pixels_release(struct tl_sun_pixels *pixels)
{
    for (int layer = 0; layer <= TL_TRANSPARENCY_LAYERS; layer++)
        for (int i = 0; i < TL_PIXEL_LIGHTS_MAX; i++)
            free(pixels->visible[layer][i]);
    free(pixels->states);
    free(pixels->minimum);
    free(pixels->maximum);
    free(pixels->marks);
    free(pixels->pixels);
    free(pixels->is_partial);
    free(pixels->cells);
    free(pixels->late);
    free(pixels->block_counts);
    *pixels = (struct tl_sun_pixels){0};
}

size_t tl_sun_pixels_bytes(const struct tl_sun_pixels *pixels)
{
    size_t each = 5 + sizeof(uint32_t);
    for (int layer = 0; layer <= TL_TRANSPARENCY_LAYERS; layer++)
        for (int i = 0; i < TL_PIXEL_LIGHTS_MAX; i++)
            each += pixels->visible[layer][i] ? sizeof(float) : 0;
    return each * pixels->capacity + (1 + sizeof(uint32_t)) * pixels->cell_capacity +
           sizeof(size_t) * (size_t)pixels->row_capacity;
}
