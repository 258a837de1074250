#include "assets/scan/scan_internal.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>

static void *grow(void *array, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity)
        return array;
    *capacity = 2 * *capacity + 256;
    return tl_resize(array, *capacity, size);
}

bool scan_add_corner(const char *path, struct scan_soup *soup, uint32_t vertex, tl_error *error)
{
    if (soup->corner_count == TL_LIMIT_MESH_INDICES)
        return tl_fail(error, TL_INPUT, "%s: has more than %zu corners of faces: simplify it", path,
                       TL_LIMIT_MESH_INDICES);
    soup->corners = grow(soup->corners, soup->corner_count, &soup->corner_capacity, sizeof *soup->corners);
    soup->corners[soup->corner_count++] = vertex;
    return true;
}

bool scan_end_face(const char *path, struct scan_soup *soup, tl_error *error)
{
    size_t first = soup->face_count > 0 ? soup->face_ends[soup->face_count - 1] : 0;
    size_t corners = soup->corner_count - first;
    if (corners > SCAN_FACE_CORNERS)
        return tl_fail(error, TL_INPUT, "%s: face %zu has %zu corners: cut it into smaller ones", path,
                       soup->face_count, corners);
    if (corners < 3) {
        soup->corner_count = first;
        return true;
    }
    soup->face_ends = grow(soup->face_ends, soup->face_count, &soup->face_capacity, sizeof *soup->face_ends);
    soup->face_ends[soup->face_count++] = soup->corner_count;
    return true;
}

bool scan_add_vertex(const char *path, struct scan_soup *soup, const struct scan_vertex *vertex,
                     tl_error *error)
{
    if (soup->vertex_count == TL_LIMIT_MESH_VERTICES)
        return tl_fail(error, TL_INPUT, "%s: has more than %zu vertices: simplify it", path,
                       TL_LIMIT_MESH_VERTICES);
    if (!isfinite(vertex->position.x + vertex->position.y + vertex->position.z))
        return tl_fail(error, TL_INPUT,
                       "%s: vertex %zu is no number, or too large for one: export the file again", path,
                       soup->vertex_count);
    soup->vertices = grow(soup->vertices, soup->vertex_count, &soup->vertex_capacity, sizeof *soup->vertices);
    soup->vertices[soup->vertex_count++] = *vertex;
    return true;
}

void scan_soup_release(struct scan_soup *soup)
{
    free(soup->vertices);
    free(soup->corners);
    free(soup->face_ends);
    *soup = (struct scan_soup){0};
}
