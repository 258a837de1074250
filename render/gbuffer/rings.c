#include "render/gbuffer/rings.h"

#include "config/base/memory.h"

#include <stdlib.h>

/* Calls `each` with the three vertices of every triangle, or the three that a vertex takes its light from. */
static void for_threes(const struct tl_triangle_ranges *ranges,
                       void (*each)(const uint32_t three[3], size_t first, struct tl_vertex_rings *rings),
                       struct tl_vertex_rings *rings)
{
    size_t first = 0;
    for (size_t s = 0; s < ranges->surface_count; s++) {
        const tl_surface *surface = ranges->surfaces[s];
        const struct tl_light_mesh *mesh = surface->light_mesh;
        for (size_t v = 0; mesh && v < surface->vertex_count; v++)
            if (mesh->from[v][0] != v)
                each(mesh->from[v], first, rings);
        for (size_t i = 0; !mesh && i < surface->index_count; i += 3)
            each(surface->indices + i, first, rings);
        first += surface->vertex_count;
    }
}

static void count_three(const uint32_t three[3], size_t first, struct tl_vertex_rings *rings)
{
    for (int k = 0; k < 3; k++)
        rings->first[first + three[k] + 1] += 2;
}

static void join_three(const uint32_t three[3], size_t first, struct tl_vertex_rings *rings)
{
    for (int k = 0; k < 3; k++)
        for (int other = 1; other < 3; other++) {
            const size_t vertex = first + three[k];
            rings->neighbours[rings->first[vertex] + rings->counts[vertex]++] =
                (uint32_t)(first + three[(k + other) % 3]);
        }
}

static int compare_numbers(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Leaves each neighbour once, and not the vertex itself. */
static void leave_once(struct tl_vertex_rings *rings, size_t vertex)
{
    uint32_t *ring = rings->neighbours + rings->first[vertex], kept = 0;
    qsort(ring, rings->counts[vertex], sizeof *ring, compare_numbers);
    for (uint32_t i = 0; i < rings->counts[vertex]; i++)
        if (ring[i] != vertex && (kept == 0 || ring[i] != ring[kept - 1]))
            ring[kept++] = ring[i];
    rings->counts[vertex] = kept;
}

struct tl_vertex_rings tl_vertex_rings_make(const struct tl_triangle_ranges *ranges)
{
    size_t count = 0;
    for (size_t s = 0; s < ranges->surface_count; s++)
        count += ranges->surfaces[s]->vertex_count;
    struct tl_vertex_rings rings = {.vertex_count = count,
                                    .first = TL_NEW_ARRAY(size_t, count + 1),
                                    .counts = TL_NEW_ARRAY(uint32_t, count)};
    for_threes(ranges, count_three, &rings);
    for (size_t v = 0; v < count; v++)
        rings.first[v + 1] += rings.first[v];
    rings.neighbours = TL_NEW_ARRAY(uint32_t, rings.first[count]);
    for_threes(ranges, join_three, &rings);
    for (size_t v = 0; v < count; v++)
        leave_once(&rings, v);
    return rings;
}

void tl_vertex_rings_release(struct tl_vertex_rings *rings)
{
    free(rings->first);
    free(rings->counts);
    free(rings->neighbours);
    *rings = (struct tl_vertex_rings){0};
}

size_t tl_vertex_rings_bytes(const struct tl_vertex_rings *rings)
{
    const size_t count = rings->vertex_count;
    return rings->first ? (count + 1) * sizeof(size_t) + (count + rings->first[count]) * sizeof(uint32_t) : 0;
}
