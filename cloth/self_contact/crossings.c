#include "cloth/self_contact/crossings.h"

#include "config/base/memory.h"

#include <stdlib.h>

/* Six times the volume of a tetrahedron; positive where d lies on the side of a b c that its normal points
 * to. */
static double volume(vec3d a, vec3d b, vec3d c, vec3d d)
{
    return vec3d_dot(vec3d_cross(vec3d_sub(b, a), vec3d_sub(c, a)), vec3d_sub(d, a));
}

static int sign(double number)
{
    return (number > 0) - (number < 0);
}

bool tl_segment_crosses(vec3d p, vec3d q, vec3d a, vec3d b, vec3d c)
{
    if (sign(volume(a, b, c, p)) * sign(volume(a, b, c, q)) >= 0)
        return false;
    int side = sign(volume(p, q, a, b));
    return side != 0 && side == sign(volume(p, q, b, c)) && side == sign(volume(p, q, c, a));
}

static bool has_corner(const uint32_t triangle[3], uint32_t vertex)
{
    return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

static bool a_side_crosses(const uint32_t sides[3], const uint32_t triangle[3], const vec3d *x)
{
    for (int i = 0; i < 3; i++) {
        uint32_t p = sides[i], q = sides[(i + 1) % 3];
        if (!has_corner(triangle, p) && !has_corner(triangle, q) &&
            tl_segment_crosses(x[p], x[q], x[triangle[0]], x[triangle[1]], x[triangle[2]]))
            return true;
    }
    return false;
}

bool tl_triangles_cross(const uint32_t a[3], const uint32_t b[3], const vec3d *x)
{
    return a_side_crosses(a, b, x) || a_side_crosses(b, a, x);
}

/* The limit of each task: none where all tasks together find at most `limit` pairs, else an equal share.
 * Found by one thread, so that the pairs that are tested do not depend on the number of threads. */
static size_t limit_of_tasks(const struct tl_near_tree *tree, size_t limit)
{
    struct tl_near_pairs pairs = {.limit = limit};
    for (size_t task = 0; task < tree->task_count && pairs.limit > 0; task++) {
        tl_near_tree_pairs(tree, task, &pairs);
        pairs.limit -= pairs.count < pairs.limit ? pairs.count : pairs.limit;
    }
    bool within = pairs.limit > 0;
    tl_near_pairs_release(&pairs);
    return within ? 0 : limit / tree->task_count + 1;
}

void tl_crossings_find(struct tl_near_tree *tree, const struct tl_topology *topology, const vec3d *x,
                       struct tl_near_pairs *out)
{
    tl_near_tree_refit(tree, topology, x, NULL, NULL);
    const size_t limit = out->limit > 0 ? limit_of_tasks(tree, out->limit) : 0;
    struct tl_near_pairs *found = TL_NEW_ARRAY(struct tl_near_pairs, tree->task_count);
#pragma omp parallel for schedule(dynamic) if (topology->vertex_count >= TL_NEAR_PARALLEL_VERTICES)
    for (size_t task = 0; task < tree->task_count; task++) {
        struct tl_near_pairs *pairs = &found[task];
        pairs->limit = limit;
        tl_near_tree_pairs(tree, task, pairs);
        size_t kept = 0;
        for (size_t i = 0; i < pairs->count; i++) {
            const uint32_t a = pairs->pairs[i][0], b = pairs->pairs[i][1];
            if (!tl_triangles_cross(topology->triangles[a], topology->triangles[b], x))
                continue;
            pairs->pairs[kept][0] = a;
            pairs->pairs[kept++][1] = b;
        }
        pairs->count = kept;
    }
    out->count = 0;
    out->cut_short = false;
    for (size_t task = 0; task < tree->task_count; task++) {
        tl_near_pairs_append(out, &found[task]);
        out->cut_short |= found[task].cut_short;
        tl_near_pairs_release(&found[task]);
    }
    free(found);
}

/* `pairs` is replaced. `known` NULL: builds a tree. */
static void find_as_drawn(struct tl_near_tree *known, const struct tl_topology *topology, const vec3d *x,
                          struct tl_near_pairs *pairs)
{
    vec3d *drawn = TL_NEW_ARRAY(vec3d, topology->vertex_count);
    for (size_t i = 0; i < topology->vertex_count; i++)
        drawn[i] = vec3d_as_drawn(x[i]);
    struct tl_near_tree own = {0};
    if (!known)
        own = tl_near_tree_create(topology, drawn);
    tl_crossings_find(known ? known : &own, topology, drawn, pairs);
    tl_near_tree_release(&own);
    free(drawn);
}

size_t tl_crossings_count(struct tl_near_tree *tree, const struct tl_topology *topology, const vec3d *x)
{
    struct tl_near_pairs pairs = {0};
    find_as_drawn(tree, topology, x, &pairs);
    size_t count = pairs.count;
    tl_near_pairs_release(&pairs);
    return count;
}

void tl_crossings_of_mesh(const tl_mesh *mesh, const vec3s *positions, struct tl_near_pairs *out)
{
    uint32_t *weld = TL_NEW_ARRAY(uint32_t, mesh->vertex_count);
    size_t places = tl_weld_positions(positions, mesh->vertex_count, weld);
    struct tl_topology topology =
        tl_topology_build(mesh->indices, mesh->index_count, weld, mesh->vertex_count, places);
    vec3d *x = TL_NEW_ARRAY(vec3d, places);
    /* A triangle's box overlaps those of about a dozen neighbours, a few times as many in layered cloth. */
    const size_t for_small = 1 << 20, of_triangle = 32;
    out->count = 0;
    out->limit = for_small + of_triangle * topology.triangle_count;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        x[weld[i]] = vec3d_from(positions[i]);
    if (topology.triangle_count > 0)
        find_as_drawn(NULL, &topology, x, out);
    for (size_t i = 0; i < out->count; i++)
        for (int side = 0; side < 2; side++)
            out->pairs[i][side] = topology.source[out->pairs[i][side]];
    tl_topology_release(&topology);
    free(x);
    free(weld);
}
