#include "cloth/mesh/simplicial.h"

#include "config/memory.h"

/* Sweeps over the triangles that are not mapped to one. */
#define SWEEPS 20

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

/* Maps a vertex of triangle `v` to the corner among those of its own coarse triangle and those that the
 * other two are mapped to which leaves the fewest bad triangles around it. Returns whether it changed. */
static bool improve(const struct tl_skin_source *source, const struct tl_fans *stars,
                    const struct tl_coarse_mesh *coarse, const uint32_t v[3], int k, uint32_t *map)
{
    const uint32_t *own = source->corners[v[k]], before = map[v[k]];
    const uint32_t wanted[5] = {map[v[(k + 1) % 3]], map[v[(k + 2) % 3]], own[0], own[1], own[2]};
    size_t fewest = bad_around(source->topology, stars, coarse, map, v[k]);
    uint32_t best = before;
    for (int i = 0; i < 5; i++) {
        map[v[k]] = wanted[i];
        const size_t count = bad_around(source->topology, stars, coarse, map, v[k]);
        best = count < fewest ? wanted[i] : best;
        fewest = count < fewest ? count : fewest;
    }
    map[v[k]] = best;
    return best != before;
}

size_t tl_simplicial_map(const struct tl_skin_source *source, const struct tl_coarse_mesh *coarse,
                         uint32_t *out)
{
    const struct tl_topology *topology = source->topology;
    for (size_t i = 0; i < topology->vertex_count; i++) {
        int largest = 0;
        for (int k = 1; k < 3; k++)
            largest = source->shares[i][k] > source->shares[i][largest] ? k : largest;
        out[i] = source->corners[i][0] == TL_NONE ? TL_NONE : source->corners[i][largest];
    }
    struct tl_fans stars = tl_fans_build((const uint32_t *)topology->triangles, 3 * topology->triangle_count,
                                         topology->vertex_count);
    bool changed = true;
    for (int sweep = 0; sweep < SWEEPS && changed; sweep++) {
        changed = false;
        for (size_t t = 0; t < topology->triangle_count; t++)
            for (int k = 0; k < 3 && !is_simplex(coarse, out, topology->triangles[t]); k++)
                changed |= improve(source, &stars, coarse, topology->triangles[t], k, out);
    }
    tl_fans_release(&stars);
    return count_bad(topology, coarse, out);
}
