#include "render/gbuffer/ids.h"

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

/* Replaces places among the triangles that were drawn by the triangles' numbers, row by row, and marks these.
 * Threads may mark one triangle at once: they write the same. */
static size_t number_row(struct tl_id_buffer *buffer, const uint32_t *numbers, int y)
{
    uint32_t *row = buffer->ids + (size_t)y * (size_t)buffer->width, before = 0, id = 0;
    size_t covered = 0;
    for (int x = 0; x < buffer->width; x++) {
        if (row[x] != before) { /* runs are the rule */
            before = row[x];
            id = 0;
            if (before != 0) {
                uint32_t triangle = numbers[(before & ~TL_SAMPLE_BACK) - 1], back = before & TL_SAMPLE_BACK;
                id = (triangle + 1) | back;
                __atomic_store_n(&buffer->marks[2 * (size_t)triangle + (back ? 1 : 0)], 1, __ATOMIC_RELAXED);
            }
        }
        row[x] = id;
        covered += id != 0;
    }
    return covered;
}

static void number_pixels(struct tl_id_buffer *buffer)
{
    const uint32_t *numbers = buffer->drawn.cull.numbers;
    size_t covered = 0;
    memset(buffer->marks, 0, 2 * buffer->triangle_count);
#pragma omp parallel for schedule(static) reduction(+ : covered)
    for (int y = 0; y < buffer->height; y++)
        covered += number_row(buffer, numbers, y);
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

bool tl_ids_draw(struct tl_id_buffer *buffer, tl_gpu *gpu, const struct tl_gbuffer_request *request,
                 const struct tl_triangle_ranges *ranges, tl_error *error)
{
    if (!tl_gbuffer_draw(&buffer->drawn, gpu, request, error))
        return false;
    reserve(buffer, request, ranges->first[ranges->surface_count]);
    glGetTextureImage(buffer->drawn.target.colours[0].id, 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
                      (GLsizei)((size_t)buffer->width * (size_t)buffer->height * sizeof *buffer->ids),
                      buffer->ids);
    number_pixels(buffer);
    list_seen(buffer);
    return true;
}

void tl_ids_release(struct tl_id_buffer *buffer)
{
    tl_gbuffer_release(&buffer->drawn);
    free(buffer->ids);
    free(buffer->seen);
    free(buffer->places);
    free(buffer->marks);
    *buffer = (struct tl_id_buffer){0};
}

size_t tl_ids_bytes(const struct tl_id_buffer *buffer)
{
    return tl_gbuffer_bytes(&buffer->drawn) + buffer->capacity * sizeof(uint32_t) +
           buffer->triangle_count * (4 * sizeof(uint32_t) + 2);
}
