#include "render/gbuffer/ids_internal.h"

#include "config/memory.h"

#include <epoxy/gl.h>

#include <stdlib.h>
#include <string.h>

static void reserve(struct tl_id_buffer *buffer, const struct tl_gbuffer_request *request, size_t triangles)
{
    size_t count = (size_t)request->width * (size_t)request->height;
    buffer->width = request->width;
    buffer->height = request->height;
    if (count > buffer->capacity) {
        free(buffer->ids);
        buffer->ids = TL_NEW_ARRAY(uint32_t, count);
        buffer->capacity = count;
    }
    if (triangles != buffer->triangle_count) {
        free(buffer->seen);
        free(buffer->places);
        free(buffer->marks);
        buffer->seen = TL_NEW_ARRAY(uint32_t, 2 * triangles);
        buffer->places = TL_NEW_ARRAY(uint32_t, 2 * triangles);
        buffer->marks = TL_NEW_ARRAY(uint8_t, 2 * triangles);
        buffer->triangle_count = triangles;
    }
}

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
    for (int y = 0; y < buffer->height; y++)
        covered += mark_row(buffer, buffer->ids + (size_t)y * (size_t)buffer->width);
    buffer->covered = covered;
}

static void list_seen(struct tl_id_buffer *buffer)
{
    buffer->seen_count = 0;
    for (size_t i = 0; i < 2 * buffer->triangle_count; i++)
        if (buffer->marks[i]) {
            buffer->places[i] = (uint32_t)buffer->seen_count;
            buffer->seen[buffer->seen_count++] = (uint32_t)(i / 2) | (i % 2 ? TL_SAMPLE_BACK : 0);
        }
}

static void finish(struct tl_id_buffer *buffer)
{
    mark_pixels(buffer);
    list_seen(buffer);
}

bool tl_ids_draw_by_gl(struct tl_id_buffer *buffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                       const struct tl_triangle_ranges *ranges, tl_error *error)
{
    if (!tl_gbuffer_draw(&buffer->drawn, gpu, request, error))
        return false;
    reserve(buffer, request, ranges->first[ranges->surface_count]);
    glGetTextureImage(buffer->drawn.target.colours[0].id, 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
                      (GLsizei)((size_t)buffer->width * (size_t)buffer->height * sizeof *buffer->ids),
                      buffer->ids);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < buffer->height; y++)
        number_row(buffer->ids + (size_t)y * (size_t)buffer->width, buffer->width,
                   buffer->drawn.cull.numbers);
    finish(buffer);
    return true;
}

void tl_ids_draw_on_cpu(struct tl_id_buffer *buffer, const struct tl_gbuffer_request *request,
                        const struct tl_triangle_ranges *ranges)
{
    const struct tl_raster_request what = {.surfaces = request->drawn,
                                           .surface_count = request->surface_count,
                                           .view_projection = request->view->view_projection,
                                           .width = request->width,
                                           .height = request->height};
    reserve(buffer, request, ranges->first[ranges->surface_count]);
    tl_raster_draw(&buffer->raster, &what, buffer->ids);
    finish(buffer);
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

bool tl_ids_draw(struct tl_id_buffer *buffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                 const struct tl_triangle_ranges *ranges, tl_error *error)
{
    if (!tl_gpu_is_software(gpu) || !fits_cpu(request))
        return tl_ids_draw_by_gl(buffer, gpu, request, ranges, error);
    tl_ids_draw_on_cpu(buffer, request, ranges);
    return true;
}

void tl_ids_release(struct tl_id_buffer *buffer)
{
    tl_gbuffer_release(&buffer->drawn);
    tl_raster_release(&buffer->raster);
    free(buffer->ids);
    free(buffer->seen);
    free(buffer->places);
    free(buffer->marks);
    *buffer = (struct tl_id_buffer){0};
}

size_t tl_ids_bytes(const struct tl_id_buffer *buffer)
{
    return tl_gbuffer_bytes(&buffer->drawn) + tl_raster_bytes(&buffer->raster) +
           buffer->capacity * sizeof(uint32_t) + buffer->triangle_count * (4 * sizeof(uint32_t) + 2);
}
