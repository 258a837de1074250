#include "render/gbuffer/ids_internal.h"

#include "config/base/memory.h"

#include <epoxy/gl.h>

#include <stdlib.h>
#include <string.h>

static void reserve_pixels(struct tl_id_buffer *buffer, const struct tl_gbuffer_request *request)
{
    size_t count = (size_t)request->width * (size_t)request->height;
    bool is_other = request->width != buffer->width || request->height != buffer->height;
    if (is_other) /* rows lie elsewhere: what they hold is unknown */
        for (int i = 0; i < TL_TRANSPARENCY_LAYERS; i++) {
            free(buffer->layers[i]);
            buffer->layers[i] = NULL;
        }
    buffer->width = request->width;
    buffer->height = request->height;
    if (count > buffer->capacity) {
        free(buffer->ids);
        buffer->ids = TL_NEW_ARRAY(uint32_t, count);
        buffer->capacity = count;
    }
}

static void reserve_triangles(struct tl_id_buffer *buffer, size_t triangles)
{
    if (triangles == buffer->triangle_count)
        return;
    free(buffer->seen);
    free(buffer->places);
    free(buffer->marks);
    buffer->seen = TL_NEW_ARRAY(uint32_t, 2 * triangles);
    buffer->places = TL_NEW_ARRAY(uint32_t, 2 * triangles);
    buffer->marks = TL_NEW_ARRAY(uint8_t, 2 * triangles);
    buffer->triangle_count = triangles;
}

static void reserve_layers(struct tl_id_buffer *buffer)
{
    if (buffer->layers[0])
        return;
    free(buffer->depths);
    buffer->depths = TL_NEW_ARRAY(uint8_t, (size_t)buffer->height);
    for (int i = 0; i < TL_TRANSPARENCY_LAYERS; i++)
        buffer->layers[i] = TL_NEW_ARRAY(uint32_t, (size_t)buffer->width * (size_t)buffer->height);
}

/* ---- Layers ---- */

static bool is_open(const tl_material *material)
{
    return material->openness > 0;
}

static bool has_open(const struct tl_gbuffer_request *request)
{
    for (size_t s = 0; s < request->surface_count; s++)
        for (size_t p = 0; p < request->drawn[s]->part_count; p++)
            if (is_open(&request->drawn[s]->materials[request->drawn[s]->parts[p].material]))
                return true;
    return false;
}

/* Begins a buffer. Returns whether there are layers behind the nearest. */
static bool begin(struct tl_id_buffer *buffer, const struct tl_gbuffer_request *request,
                  const struct tl_triangle_ranges *ranges, bool is_whole)
{
    bool is_layered = is_whole && has_open(request);
    reserve_pixels(buffer, request);
    if (is_whole)
        reserve_triangles(buffer, ranges->first[ranges->surface_count]);
    if (is_layered)
        reserve_layers(buffer);
    buffer->layer_count = 1;
    return is_layered;
}

static void count_layers(struct tl_id_buffer *buffer)
{
    for (int y = 0; y < buffer->height; y++)
        buffer->layer_count =
            1 + buffer->depths[y] > buffer->layer_count ? 1 + buffer->depths[y] : buffer->layer_count;
}

/* ---- Visible triangles ---- */

/* Marks the triangles of a row and counts its covered pixels. Threads may mark one triangle at once: they
 * write the same. */
static size_t mark_row(struct tl_id_buffer *buffer, const uint32_t *row)
{
    uint32_t before = 0;
    size_t covered = 0;
    for (int x = 0; x < buffer->width; x++) {
        if (row[x] != before) {
            before = row[x];
            if (before != 0)
                __atomic_store_n(&buffer->marks[tl_ids_mark(before)], 1, __ATOMIC_RELAXED);
        }
        covered += row[x] != 0;
    }
    return covered;
}

static void mark_pixels(struct tl_id_buffer *buffer)
{
    size_t covered = 0;
    memset(buffer->marks, 0, 2 * buffer->triangle_count);
#pragma omp parallel for schedule(static) reduction(+ : covered)
    for (int y = 0; y < buffer->height; y++) {
        const size_t row = (size_t)y * (size_t)buffer->width;
        covered += mark_row(buffer, buffer->ids + row);
        for (int layer = 0; buffer->layer_count > 1 && layer < buffer->depths[y]; layer++)
            covered += mark_row(buffer, buffer->layers[layer] + row);
    }
    buffer->covered = covered;
}

/* Light that comes through a triangle is that of its other side. */
static void mark_other_sides(struct tl_id_buffer *buffer, const struct tl_triangle_ranges *ranges)
{
    for (size_t s = 0; s < ranges->surface_count; s++) {
        const tl_surface *surface = ranges->surfaces[s];
        for (size_t p = 0; p < surface->part_count; p++) {
            const struct tl_mesh_part *part = &surface->parts[p];
            if (!tl_material_transmits(&surface->materials[part->material]))
                continue;
            uint8_t *marks = buffer->marks + 2 * ((size_t)ranges->first[s] + part->first_index / 3);
            for (size_t t = 0; t < part->index_count / 3; t++)
                marks[2 * t] = marks[2 * t + 1] = marks[2 * t] | marks[2 * t + 1];
        }
    }
}

static void list_seen(struct tl_id_buffer *buffer, const struct tl_triangle_ranges *ranges)
{
    mark_pixels(buffer);
    mark_other_sides(buffer, ranges);
    buffer->seen_count = 0;
    for (size_t i = 0; i < 2 * buffer->triangle_count; i++)
        if (buffer->marks[i]) {
            buffer->places[i] = (uint32_t)buffer->seen_count;
            buffer->seen[buffer->seen_count++] = (uint32_t)(i / 2) | (i % 2 ? TL_SAMPLE_BACK : 0);
        }
}

/* ---- GL ---- */

/* Replaces places among the triangles that were drawn by the triangles' numbers. */
static void number_row(uint32_t *row, int width, const uint32_t *numbers)
{
    uint32_t before = 0, id = 0;
    for (int x = 0; x < width; x++) {
        if (row[x] != before) { /* runs are the rule */
            before = row[x];
            id = before != 0 ? (numbers[(before & ~TL_SAMPLE_BACK) - 1] + 1) | (before & TL_SAMPLE_BACK) : 0;
        }
        row[x] = id;
    }
}

/* Reads what was drawn. */
static void read_ids(const struct tl_id_buffer *buffer, const struct tl_gbuffer *drawn, uint32_t *ids)
{
    glGetTextureImage(drawn->target.colours[0].id, 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
                      (GLsizei)((size_t)buffer->width * (size_t)buffer->height * sizeof *ids), ids);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < buffer->height; y++)
        number_row(ids + (size_t)y * (size_t)buffer->width, buffer->width, drawn->cull.numbers);
}

/* Keeps what lies behind open triangles of the layer before, row by row. Returns whether anything does. */
static bool keep_behind(const struct tl_id_buffer *buffer, const struct tl_triangle_ranges *ranges,
                        const uint32_t *before, int layer)
{
    uint32_t *ids = buffer->layers[layer];
    int rows = 0;
#pragma omp parallel for schedule(static) reduction(+ : rows)
    for (int y = 0; y < buffer->height; y++) {
        uint32_t nearer = 0;
        bool keeps = false, any = false;
        for (int x = 0; x < buffer->width; x++) {
            size_t pixel = (size_t)y * (size_t)buffer->width + (size_t)x;
            if (before[pixel] != nearer) {
                nearer = before[pixel];
                keeps = nearer != 0 && is_open(tl_triangle_material(ranges, (nearer & ~TL_SAMPLE_BACK) - 1));
            }
            ids[pixel] = keeps ? ids[pixel] : 0;
            any |= ids[pixel] != 0;
        }
        if (any)
            buffer->depths[y] = (uint8_t)(layer + 1);
        rows += any;
    }
    return rows > 0;
}

static bool draw_behind(struct tl_id_buffer *buffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                        const struct tl_triangle_ranges *ranges, tl_error *error)
{
    struct tl_gbuffer_request draw = *request;
    bool any = true;
    draw.passed = &buffer->drawn.target.depth;
    memset(buffer->depths, 0, (size_t)buffer->height);
    for (int layer = 0; layer < TL_TRANSPARENCY_LAYERS; layer++) {
        if (!any) {
            memset(buffer->layers[layer], 0,
                   (size_t)buffer->width * (size_t)buffer->height * sizeof(uint32_t));
            continue;
        }
        if (!tl_gbuffer_draw(&buffer->behind, gpu, &draw, error))
            return false;
        read_ids(buffer, &buffer->behind, buffer->layers[layer]);
        any = keep_behind(buffer, ranges, layer > 0 ? buffer->layers[layer - 1] : buffer->ids, layer);
        tl_gbuffer_keep_depth(&buffer->behind, gpu, &buffer->passed);
        draw.passed = &buffer->passed;
    }
    count_layers(buffer);
    return true;
}

bool tl_ids_draw_by_gl(struct tl_id_buffer *buffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                       const struct tl_triangle_ranges *ranges, bool is_whole, tl_error *error)
{
    if (!tl_gbuffer_draw(&buffer->drawn, gpu, request, error))
        return false;
    bool is_layered = begin(buffer, request, ranges, is_whole);
    read_ids(buffer, &buffer->drawn, buffer->ids);
    if (is_layered && !draw_behind(buffer, gpu, request, ranges, error))
        return false;
    if (is_whole)
        list_seen(buffer, ranges);
    return true;
}

/* ---- On the CPU ---- */

void tl_ids_draw_on_cpu(struct tl_id_buffer *buffer, const struct tl_gbuffer_request *request,
                        const struct tl_triangle_ranges *ranges, bool is_whole)
{
    const struct tl_raster_request what = {.surfaces = request->drawn,
                                           .surface_count = request->surface_count,
                                           .view_projection = request->view->view_projection,
                                           .width = request->width,
                                           .height = request->height,
                                           .is_layered = begin(buffer, request, ranges, is_whole)};
    struct tl_raster_layers layers = {.nearest = buffer->ids, .depths = buffer->depths};
    memcpy(layers.behind, buffer->layers, sizeof layers.behind);
    tl_raster_draw(&buffer->raster, &what, &layers);
    if (what.is_layered)
        count_layers(buffer);
    if (is_whole)
        list_seen(buffer, ranges);
}

/* Holes need the maps, which only GL's program reads here. */
static bool fits_cpu(const struct tl_gbuffer_request *request)
{
    for (size_t i = 0; i < request->surface_count; i++)
        if (tl_surfaces_is_hidden(request->surfaces, i))
            return false;
    return !tl_surfaces_have(request->surfaces, TL_PARTS_MASKED) && request->width <= TL_RASTER_SIDE_MAX &&
           request->height <= TL_RASTER_SIDE_MAX;
}

static bool draw(struct tl_id_buffer *buffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                 const struct tl_triangle_ranges *ranges, bool is_whole, tl_error *error)
{
    if (!tl_gpu_is_software(gpu) || !fits_cpu(request))
        return tl_ids_draw_by_gl(buffer, gpu, request, ranges, is_whole, error);
    tl_ids_draw_on_cpu(buffer, request, ranges, is_whole);
    return true;
}

bool tl_ids_draw(struct tl_id_buffer *buffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                 const struct tl_triangle_ranges *ranges, tl_error *error)
{
    return draw(buffer, gpu, request, ranges, true, error);
}

bool tl_ids_draw_nearest(struct tl_id_buffer *buffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                         const struct tl_triangle_ranges *ranges, tl_error *error)
{
    return draw(buffer, gpu, request, ranges, false, error);
}

bool tl_ids_reload(struct tl_id_buffer *buffer, tl_error *error)
{
    return tl_gbuffer_reload(&buffer->drawn, error) && tl_gbuffer_reload(&buffer->behind, error);
}

void tl_ids_release(struct tl_id_buffer *buffer)
{
    tl_gbuffer_release(&buffer->drawn);
    tl_gbuffer_release(&buffer->behind);
    tl_texture_destroy(&buffer->passed);
    tl_raster_release(&buffer->raster);
    for (int i = 0; i < TL_TRANSPARENCY_LAYERS; i++)
        free(buffer->layers[i]);
    free(buffer->depths);
    free(buffer->ids);
    free(buffer->seen);
    free(buffer->places);
    free(buffer->marks);
    *buffer = (struct tl_id_buffer){0};
}

size_t tl_ids_bytes(const struct tl_id_buffer *buffer)
{
    size_t layers = 0;
    for (int i = 0; i < TL_TRANSPARENCY_LAYERS; i++)
        layers += buffer->layers[i] != NULL;
    return tl_gbuffer_bytes(&buffer->drawn) + tl_gbuffer_bytes(&buffer->behind) +
           tl_texture_bytes(&buffer->passed) + tl_raster_bytes(&buffer->raster) +
           buffer->capacity * sizeof(uint32_t) +
           layers * (size_t)buffer->width * (size_t)buffer->height * sizeof(uint32_t) +
           buffer->triangle_count * (4 * sizeof(uint32_t) + 2);
}
