#include "cloth/cage/simplicial.h"

#include "config/base/memory.h"

/* Sweeps over the triangles that are not mapped to one. */
#define SWEEPS 100

static bool has(const uint32_t triangle[3], uint32_t bone)
{
    return triangle[0] == bone || triangle[1] == bone || triangle[2] == bone;
}

static bool is_simplex(const struct tl_coarse_mesh *coarse, const uint32_t *map, const uint32_t v[3])
{
    const uint32_t a = map[v[0]], b = map[v[1]], c = map[v[2]];
    for (uint32_t n = coarse->fans->first[a]; n < coarse->fans->first[a + 1]; n++) {
        const uint32_t *triangle = coarse->triangles[coarse->fans->items[n] / 3];
        if (has(triangle, b) && has(triangle, c))
            return true;
    }
    return false;
}

static size_t count_bad(const struct tl_topology *topology, const struct tl_coarse_mesh *coarse,
                        const uint32_t *map)
{
    size_t count = 0;
    for (size_t t = 0; t < topology->triangle_count; t++)
        count += !is_simplex(coarse, map, topology->triangles[t]);
    return count;
}

static size_t bad_around(const struct tl_topology *topology, const struct tl_fans *stars,
                         const struct tl_coarse_mesh *coarse, const uint32_t *map, uint32_t vertex)
{
    size_t count = 0;
    for (uint32_t n = stars->first[vertex]; n < stars->first[vertex + 1]; n++)
        count += !is_simplex(coarse, map, topology->triangles[stars->items[n] / 3]);
    return count;
}

struct bone_search {
    const struct tl_skin_source *source;
    const struct tl_coarse_mesh *coarse;
    struct tl_fans stars; /* corners of the fine triangles around each vertex */
    uint32_t *map;
};

/* Maps a vertex to a bone that it or one around it has, with the fewest bad triangles around it; of equally
 * good ones to another than before, so that the next sweep starts elsewhere. */
static void improve(struct bone_search *search, uint32_t vertex)
{
    const struct tl_topology *topology = search->source->topology;
    const uint32_t before = search->map[vertex];
    const uint32_t first = search->stars.first[vertex], end = search->stars.first[vertex + 1];
    uint32_t best = before;
    size_t fewest = SIZE_MAX;
    for (uint32_t n = 3 * first; n < 3 * end + 3; n++) {
        const uint32_t *around = topology->triangles[search->stars.items[n < 3 * end ? n / 3 : first] / 3];
        const uint32_t wanted =
            n < 3 * end ? search->map[around[n % 3]] : search->source->corners[vertex][n % 3];
        if (wanted == before)
            continue;
        search->map[vertex] = wanted;
        const size_t count = bad_around(topology, &search->stars, search->coarse, search->map, vertex);
        search->map[vertex] = before;
        best = count < fewest ? wanted : best;
        fewest = count < fewest ? count : fewest;
    }
    if (fewest <= bad_around(topology, &search->stars, search->coarse, search->map, vertex))
        search->map[vertex] = best;
}

static void map_to_largest(const struct tl_skin_source *source, uint32_t *out)
{
    for (size_t i = 0; i < source->topology->vertex_count; i++) {
        int largest = 0;
        for (int k = 1; k < 3; k++)
            largest = source->shares[i][k] > source->shares[i][largest] ? k : largest;
        out[i] = source->corners[i][0] == TL_NONE ? TL_NONE : source->corners[i][largest];
    }
}

size_t tl_simplicial_map(const struct tl_skin_source *source, const struct tl_coarse_mesh *coarse,
                         uint32_t *out)
{
    const struct tl_topology *topology = source->topology;
    struct bone_search search = {source, coarse,
                                 tl_fans_build((const uint32_t *)topology->triangles,
                                               3 * topology->triangle_count, topology->vertex_count),
                                 out};
    map_to_largest(source, out);
    size_t bad = count_bad(topology, coarse, out);
    for (uint32_t sweep = 0; sweep < SWEEPS && bad > 0; sweep++) {
        for (size_t t = 0; t < topology->triangle_count; t++)
            for (uint32_t k = 0; k < 3 && !is_simplex(coarse, out, topology->triangles[t]); k++)
                improve(&search, topology->triangles[t][(k + sweep) % 3]);
        bad = count_bad(topology, coarse, out);
    }
    tl_fans_release(&search.stars);
    return bad;
}
