#include "render/shade/sun_pixels.h"

#include "config/memory.h"
#include "render/env/cube.h"
#include "render/visibility/sun_rays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define CELL            4  /* pixels a side */
#define BUNDLE          16 /* rays */
#define ROWS            16 /* that a thread takes at a time */
#define MORE            8  /* rays for a pixel in it */
#define SEEN_SUN(state) ((state) == DARK || (state) == LIT)

/* What a pixel sees of the sun. DARK and LIT are bits. */
enum state { UNKNOWN = 0, DARK = 1, LIT = 2, AWAY = 4, EMPTY = 8 };

static void reserve(struct tl_sun_pixels *pixels, size_t count, int suns)
{
    if (count > pixels->capacity) {
        tl_sun_pixels_release(pixels);
        pixels->capacity = count;
        pixels->states = TL_NEW_ARRAY(uint8_t, count);
        pixels->spread = TL_NEW_ARRAY(uint8_t, count);
        pixels->pixels = TL_NEW_ARRAY(uint32_t, count);
        pixels->starts = TL_NEW_ARRAY(vec3s, count);
        pixels->is_settled = TL_NEW_ARRAY(uint8_t, count);
    }
    for (int i = 0; i < suns; i++)
        if (!pixels->visible[i])
            pixels->visible[i] = TL_NEW_ARRAY(float, pixels->capacity);
}

/* Rays that are gathered until they are a bundle. */
struct bundle {
    const struct tl_sun_pixels_request *request;
    vec3s direction;
    float offset_m;
    struct tl_ray_packet rays;
    uint32_t pixels[BUNDLE];
    float ground[BUNDLE]; /* what the ground leaves */
    size_t count;         /* rays traced so far */
};

static struct bundle begin_bundle(const struct tl_sun_pixels_request *request, vec3s direction)
{
    return (struct bundle){.request = request,
                           .direction = direction,
                           .offset_m = tl_trace_offset(request->trace),
                           .rays = {.to_m = INFINITY, .coherent = true}};
}

static const struct tl_pixel_triangle *triangle_at(const struct tl_sun_pixels_request *request, size_t pixel)
{
    return &request->triangles[tl_ids_place(request->ids, request->ids->ids[pixel])];
}

static vec3s weighted(const vec3s v[3], const float w[3])
{
    return glms_vec3_add(glms_vec3_scale(v[0], w[0]),
                         glms_vec3_add(glms_vec3_scale(v[1], w[1]), glms_vec3_scale(v[2], w[2])));
}

/* The origin of a covered pixel's rays, as tl_sample_start has it. False where the surface faces away. */
static bool start_of(const struct bundle *bundle, uint32_t pixel, vec3s *start)
{
    const struct tl_id_buffer *ids = bundle->request->ids;
    const struct tl_pixel_triangle *triangle = triangle_at(bundle->request, pixel);
    const uint32_t x = pixel % (uint32_t)ids->width, y = pixel / (uint32_t)ids->width;
    const struct tl_pixel_weights weights = tl_pixel_weigh(triangle, (float)x + 0.5f, (float)y + 0.5f);
    vec3s corners[3], normals[3];
    for (int i = 0; i < 3; i++) {
        corners[i] = triangle->surface->positions[triangle->corners[i]];
        normals[i] =
            glms_vec3_scale(triangle->surface->normals[triangle->corners[i]], triangle->back ? -1.0f : 1.0f);
    }
    vec3s smooth = glms_vec3_normalize(weighted(normals, weights.at));
    if (!(glms_vec3_dot(smooth, bundle->direction) > 0))
        return false;
    vec3s point = tl_smooth_point(weighted(corners, weights.at), corners, normals, weights.at);
    *start = glms_vec3_add(point, glms_vec3_scale(smooth, bundle->offset_m));
    return true;
}

/* Traces what was gathered: seen[i] of pixels[i]. Returns how many there were. */
static int trace_bundle(struct bundle *bundle, float seen[BUNDLE])
{
    int count = bundle->rays.count;
    if (count > 0)
        tl_trace_transmittance_packet(bundle->request->trace, &bundle->rays, seen);
    for (int i = 0; i < count; i++)
        seen[i] *= bundle->ground[i];
    bundle->count += (size_t)count;
    bundle->rays.count = 0;
    return count;
}

static void add_ray(struct bundle *bundle, uint32_t pixel, vec3s start)
{
    int k = bundle->rays.count++;
    bundle->pixels[k] = pixel;
    bundle->ground[k] = tl_ground_visibility(bundle->request->ground, start, bundle->direction);
    bundle->rays.origin_x[k] = start.x;
    bundle->rays.origin_y[k] = start.y;
    bundle->rays.origin_z[k] = start.z;
    bundle->rays.direction_x[k] = bundle->direction.x;
    bundle->rays.direction_y[k] = bundle->direction.y;
    bundle->rays.direction_z[k] = bundle->direction.z;
}

static void mark_bundle(struct bundle *bundle, uint8_t *states)
{
    float seen[BUNDLE];
    int count = trace_bundle(bundle, seen);
    for (int i = 0; i < count; i++)
        states[bundle->pixels[i]] = seen[i] > 0.5f ? LIT : DARK;
}

/* Decides one pixel that nothing is known of, now or with its bundle. */
static void decide(struct bundle *bundle, uint32_t pixel, uint8_t *states)
{
    vec3s start;
    if (bundle->request->ids->ids[pixel] == 0) {
        states[pixel] = EMPTY;
        return;
    }
    if (!start_of(bundle, pixel, &start)) {
        states[pixel] = AWAY;
        return;
    }
    add_ray(bundle, pixel, start);
    if (bundle->rays.count == BUNDLE)
        mark_bundle(bundle, states);
}

/* The last cell of a row ends at the last pixel. */
static int next_line(int at, int size)
{
    return at + CELL < size - 1 ? at + CELL : size - 1;
}

/* First every fourth pixel each way, and the last ones. */
static size_t look_at_grid(const struct tl_sun_pixels_request *request, vec3s direction, uint8_t *states)
{
    const int width = request->ids->width, height = request->ids->height;
    const int lines = (height - 1 + CELL - 1) / CELL + 1;
    size_t rays = 0;
#pragma omp parallel for schedule(dynamic, 4) reduction(+ : rays)
    for (int line = 0; line < lines; line++) {
        struct bundle bundle = begin_bundle(request, direction);
        int y = line * CELL < height ? line * CELL : height - 1;
        for (int x = 0;; x = next_line(x, width)) {
            decide(&bundle, (uint32_t)y * (uint32_t)width + (uint32_t)x, states);
            if (x == width - 1)
                break;
        }
        mark_bundle(&bundle, states);
        rays += bundle.count;
    }
    return rays;
}

/* A cell of the grid: its corners' state where they agree, and their surface. */
struct cell {
    int x, y, end_x, end_y;
    bool is_one;
    uint8_t state;
    size_t surface;
};

static void look_at_cell(const struct tl_sun_pixels_request *request, const uint8_t *states,
                         struct cell *cell)
{
    const uint32_t width = (uint32_t)request->ids->width;
    const uint32_t corners[4] = {(uint32_t)cell->y * width + (uint32_t)cell->x,
                                 (uint32_t)cell->y * width + (uint32_t)cell->end_x,
                                 (uint32_t)cell->end_y * width + (uint32_t)cell->x,
                                 (uint32_t)cell->end_y * width + (uint32_t)cell->end_x};
    cell->state = states[corners[0]];
    cell->is_one = SEEN_SUN(cell->state);
    if (!cell->is_one)
        return;
    cell->surface = triangle_at(request, corners[0])->surface_index;
    for (int i = 1; i < 4 && cell->is_one; i++)
        cell->is_one = states[corners[i]] == cell->state &&
                       triangle_at(request, corners[i])->surface_index == cell->surface;
}

/* Fills a cell whose corners agree, and decides its other pixels. Pixels on the lines at its ends are left to
 * the next cell, but at the picture's ends. */
static void fill_cell(struct bundle *bundle, const struct cell *cell, uint8_t *states)
{
    const struct tl_id_buffer *ids = bundle->request->ids;
    int last_x = cell->end_x < ids->width - 1 ? cell->end_x - 1 : cell->end_x;
    int last_y = cell->end_y < ids->height - 1 ? cell->end_y - 1 : cell->end_y;
    for (int y = cell->y; y <= last_y; y++)
        for (int x = cell->x; x <= last_x; x++) {
            uint32_t pixel = (uint32_t)y * (uint32_t)ids->width + (uint32_t)x;
            if (states[pixel] != UNKNOWN)
                continue;
            if (ids->ids[pixel] == 0)
                states[pixel] = EMPTY;
            else if (cell->is_one && triangle_at(bundle->request, pixel)->surface_index == cell->surface)
                states[pixel] = cell->state;
            else
                decide(bundle, pixel, states);
        }
}

static size_t fill_cells(const struct tl_sun_pixels_request *request, vec3s direction, uint8_t *states)
{
    const int width = request->ids->width, height = request->ids->height;
    size_t rays = 0;
#pragma omp parallel for schedule(dynamic, 4) reduction(+ : rays)
    for (int y = 0; y < height; y += CELL) {
        struct bundle bundle = begin_bundle(request, direction);
        struct cell cell = {.y = y, .end_y = next_line(y, height)};
        for (cell.x = 0; cell.x < width; cell.x += CELL) {
            cell.end_x = next_line(cell.x, width);
            look_at_cell(request, states, &cell);
            fill_cell(&bundle, &cell, states);
        }
        mark_bundle(&bundle, states);
        rays += bundle.count;
    }
    return rays;
}

/* Pixels near the edge of a shadow, with the origins of their rays. */
struct penumbra {
    size_t count;
    uint32_t *pixels;
    vec3s *starts;
    uint8_t *is_settled; /* its first rays all agree: it lies beyond the penumbra */
};

/* Lists the pixels of some rows that see the edge of a shadow near by. */
static void list_penumbra(const struct tl_sun_pixels *pixels, const struct bundle *bundle, float *visible,
                          int first_row, int end_row, struct penumbra *out)
{
    const int width = bundle->request->ids->width, height = bundle->request->ids->height;
    for (int y = first_row; y < end_row; y++) {
        int first = y > TL_SUN_REACH ? y - TL_SUN_REACH : 0,
            last = y + TL_SUN_REACH < height ? y + TL_SUN_REACH : height - 1;
        const size_t row = (size_t)y * (size_t)width;
        for (size_t x = 0; x < (size_t)width; x++) {
            uint8_t state = pixels->states[row + x], about = 0;
            visible[row + x] = state == LIT ? 1 : 0;
            if (!SEEN_SUN(state))
                continue;
            for (int k = first; k <= last; k++)
                about |= pixels->spread[(size_t)k * (size_t)width + x];
            if ((about & (DARK | LIT)) != (DARK | LIT) ||
                !start_of(bundle, (uint32_t)(row + x), &out->starts[out->count]))
                continue;
            out->is_settled[out->count] = false;
            out->pixels[out->count++] = (uint32_t)(row + x);
        }
    }
}

/* Adds what the pixels see of places [first, last] of the sun to `visible`. */
static size_t look_at_places(const struct penumbra *penumbra, const struct tl_sun_pixels_request *request,
                             const struct tl_sun *sun, int first, int last, float *visible)
{
    size_t rays = 0;
    for (int k = first; k <= last; k++) {
        struct bundle bundle =
            begin_bundle(request, tl_turn_direction(sun->samples[k], request->environment_yaw));
        for (size_t i = 0; i < penumbra->count; i++) {
            float seen[BUNDLE];
            if (!penumbra->is_settled[i])
                add_ray(&bundle, penumbra->pixels[i], penumbra->starts[i]);
            if (bundle.rays.count == BUNDLE || i + 1 == penumbra->count)
                for (int n = trace_bundle(&bundle, seen), j = 0; j < n; j++)
                    visible[bundle.pixels[j]] += seen[j];
        }
        rays += bundle.count;
    }
    return rays;
}

/* Means over all rays of a pixel; where the first ones agree there are no others. */
static size_t soften_rows(const struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request,
                          int sun, int first_row, int end_row)
{
    const struct tl_sun *item = &request->suns->items[sun];
    float *visible = pixels->visible[sun];
    const size_t begin = (size_t)first_row * (size_t)request->ids->width;
    struct penumbra penumbra = {.pixels = pixels->pixels + begin,
                                .starts = pixels->starts + begin,
                                .is_settled = pixels->is_settled + begin};
    const struct bundle bundle =
        begin_bundle(request, tl_turn_direction(item->direction, request->environment_yaw));
    list_penumbra(pixels, &bundle, visible, first_row, end_row, &penumbra);
    int more = item->sample_count - 1 < MORE ? item->sample_count - 1 : MORE, half = more / 2;
    size_t rays = look_at_places(&penumbra, request, item, 1, half, visible);
    for (size_t i = 0; i < penumbra.count; i++) {
        float sum = visible[penumbra.pixels[i]];
        penumbra.is_settled[i] = sum <= 0 || sum >= (float)(1 + half);
    }
    rays += look_at_places(&penumbra, request, item, half + 1, more, visible);
    for (size_t i = 0; i < penumbra.count && more > 0; i++)
        visible[penumbra.pixels[i]] /= (float)(1 + (penumbra.is_settled[i] ? half : more));
    return rays;
}

static size_t soften(const struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request, int sun)
{
    const int width = request->ids->width, height = request->ids->height;
    size_t rays = 0;
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++)
        tl_sun_spread_along(pixels->states + (size_t)y * (size_t)width,
                            pixels->spread + (size_t)y * (size_t)width, width);
#pragma omp parallel for schedule(dynamic) reduction(+ : rays)
    for (int y = 0; y < height; y += ROWS)
        rays += soften_rows(pixels, request, sun, y, y + ROWS < height ? y + ROWS : height);
    return rays;
}

void tl_sun_pixels_update(struct tl_sun_pixels *pixels, const struct tl_sun_pixels_request *request)
{
    size_t count = (size_t)request->ids->width * (size_t)request->ids->height;
    reserve(pixels, count, request->suns->count);
    pixels->rays = 0;
    for (int sun = 0; sun < request->suns->count; sun++) {
        const struct tl_sun *item = &request->suns->items[sun];
        vec3s direction = tl_turn_direction(item->sample_count > 0 ? item->samples[0] : item->direction,
                                            request->environment_yaw);
        memset(pixels->states, UNKNOWN, count);
        pixels->rays += look_at_grid(request, direction, pixels->states);
        pixels->rays += fill_cells(request, direction, pixels->states);
        pixels->rays += soften(pixels, request, sun);
    }
}

void tl_sun_pixels_release(struct tl_sun_pixels *pixels)
{
    for (int i = 0; i < TL_SUNS_MAX; i++)
        free(pixels->visible[i]);
    free(pixels->states);
    free(pixels->spread);
    free(pixels->pixels);
    free(pixels->starts);
    free(pixels->is_settled);
    *pixels = (struct tl_sun_pixels){0};
}

size_t tl_sun_pixels_bytes(const struct tl_sun_pixels *pixels)
{
    size_t each = 3 + sizeof(uint32_t) + sizeof(vec3s);
    for (int i = 0; i < TL_SUNS_MAX; i++)
        each += pixels->visible[i] ? sizeof(float) : 0;
    return each * pixels->capacity;
}
