#include "cloth/self_contact/untangle.h"

#include "cloth/self_contact/crossings.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* m/s */
#define PUSH_SPEED 0.5
/* A direction shorter than this, where contours are about to vanish, pushes by less than PUSH_SPEED. */
#define SOFTENING 0.2
/* Least |cosine| of an edge with a triangle's normal that a direction is divided by, and the direction's
 * bound. */
#define LEAST_COSINE 0.1
#define LONGEST      3.0

/* An edge passes through a triangle. */
struct crossing {
    uint32_t face, corner; /* the edge, as that side of one of its triangles which faces a corner */
    uint32_t triangle;
    vec3d way; /* the edge's displacement against the triangle that shortens the contour */
};

struct crossing_list {
    size_t count, capacity;
    struct crossing *crossings;
};

void tl_untangle_release(struct tl_untangle *untangle)
{
    free(untangle->free_keys);
    free(untangle->push);
    *untangle = (struct tl_untangle){0};
}

/* ---- Crossings ---- */

static void add_sides(const struct tl_near *near, uint32_t face, uint32_t triangle, const vec3d *x,
                      struct crossing_list *list)
{
    const uint32_t *sides = near->topology->triangles[face], *t = near->topology->triangles[triangle];
    for (uint32_t corner = 0; corner < 3; corner++) {
        uint32_t p = sides[(corner + 1) % 3], q = sides[(corner + 2) % 3];
        bool touches = p == t[0] || p == t[1] || p == t[2] || q == t[0] || q == t[1] || q == t[2];
        bool owned = near->owns[face] >> (3 + corner) & 1;
        if (touches || !owned || !tl_segment_crosses(x[p], x[q], x[t[0]], x[t[1]], x[t[2]]))
            continue;
        if (list->count == list->capacity) {
            list->capacity = 2 * list->capacity + 64;
            list->crossings = tl_resize(list->crossings, list->capacity, sizeof *list->crossings);
        }
        list->crossings[list->count++] =
            (struct crossing){.face = face, .corner = corner, .triangle = triangle};
    }
}

static void edge_of(const struct tl_near *near, const struct crossing *crossing, uint32_t out[2])
{
    const uint32_t *v = near->topology->triangles[crossing->face];
    out[0] = v[(crossing->corner + 1) % 3];
    out[1] = v[(crossing->corner + 2) % 3];
}

static vec3d normal_of(const uint32_t v[3], const vec3d *x)
{
    return vec3d_unit_or(vec3d_cross(vec3d_sub(x[v[1]], x[v[0]]), vec3d_sub(x[v[2]], x[v[0]])),
                         (vec3d){0, 1, 0});
}

/* The direction from the edge into one of its faces, along the line in which the face passes through the
 * triangle. */
static vec3d into_face(const uint32_t face[3], const uint32_t edge[2], vec3d normal, const vec3d *x)
{
    vec3d along = vec3d_unit_or(vec3d_cross(normal_of(face, x), normal), (vec3d){0});
    uint32_t far = face[0];
    for (int i = 1; i < 3; i++)
        far = face[i] != edge[0] && face[i] != edge[1] ? face[i] : far;
    vec3d side = vec3d_sub(x[edge[1]], x[edge[0]]), inward = vec3d_sub(x[far], x[edge[0]]);
    inward = vec3d_muladd(inward, side, -vec3d_dot(inward, side) / tl_max(vec3d_dot(side, side), 1e-300));
    return vec3d_scale(along, vec3d_dot(along, inward) < 0 ? -1 : 1);
}

static vec3d way_of(const struct tl_near *near, const struct crossing *crossing, const vec3d *x)
{
    const struct tl_topology *topology = near->topology;
    uint32_t edge[2], across = topology->neighbour[crossing->face][crossing->corner];
    edge_of(near, crossing, edge);
    vec3d normal = normal_of(topology->triangles[crossing->triangle], x), way = {0};
    vec3d along = vec3d_unit_or(vec3d_sub(x[edge[1]], x[edge[0]]), (vec3d){1, 0, 0});
    double cosine = vec3d_dot(along, normal);
    cosine = cosine < 0 ? tl_min(cosine, -LEAST_COSINE) : tl_max(cosine, LEAST_COSINE);
    const uint32_t faces[2] = {crossing->face, across};
    for (int i = 0; i < 2; i++) {
        if (faces[i] == TL_NONE)
            continue;
        vec3d inward = into_face(topology->triangles[faces[i]], edge, normal, x);
        way = vec3d_add(way, vec3d_muladd(inward, normal, -vec3d_dot(along, inward) / cosine));
    }
    double length = vec3d_norm(way);
    return length > LONGEST ? vec3d_scale(way, LONGEST / length) : way;
}

/* ---- Contours ---- */

static bool is_side(const uint32_t triangle[3], const uint32_t edge[2])
{
    int found = 0;
    for (int i = 0; i < 3; i++)
        found += triangle[i] == edge[0] || triangle[i] == edge[1];
    return found == 2;
}

static bool has_face(const struct tl_near *near, const struct crossing *crossing, uint32_t triangle)
{
    uint32_t across = near->topology->neighbour[crossing->face][crossing->corner];
    return crossing->face == triangle || across == triangle;
}

/* 1: both are ends of one piece of a contour and their edges pass the same triangle; -1: each one's edge is a
 * side of the other's triangle; 0: neither. */
static int link_of(const struct tl_near *near, const struct crossing *a, const struct crossing *b)
{
    uint32_t across = near->topology->neighbour[a->face][a->corner], edge[2];
    if (a->triangle == b->triangle)
        return has_face(near, b, a->face) || (across != TL_NONE && has_face(near, b, across));
    edge_of(near, b, edge);
    return has_face(near, a, b->triangle) && is_side(near->topology->triangles[a->triangle], edge) ? -1 : 0;
}

/* Joins the ways of each contour's crossings to one. Sets of crossings with the sense of each against its
 * set's root (union-find with parity). */
static void join_contours(const struct tl_near *near, struct crossing_list *list)
{
    uint32_t *parent = TL_NEW_ARRAY(uint32_t, list->count);
    int *sense = TL_NEW_ARRAY(int, list->count); /* against the parent */
    vec3d *sums = TL_NEW_ARRAY(vec3d, list->count);
    for (size_t i = 0; i < list->count; i++) {
        parent[i] = (uint32_t)i;
        sense[i] = 1;
    }
    for (uint32_t i = 0; i < list->count; i++)
        for (uint32_t k = 0; k < i; k++) {
            int link = link_of(near, &list->crossings[i], &list->crossings[k]);
            uint32_t a = i, b = k;
            int sense_a = 1, sense_b = 1;
            if (link == 0)
                continue;
            for (; parent[a] != a; a = parent[a])
                sense_a *= sense[a];
            for (; parent[b] != b; b = parent[b])
                sense_b *= sense[b];
            if (a == b)
                continue;
            parent[a] = b;
            sense[a] = link * sense_a * sense_b;
        }
    for (int give = 0; give < 2; give++)
        for (uint32_t i = 0; i < list->count; i++) {
            uint32_t root = i;
            double sign = 1;
            for (; parent[root] != root; root = parent[root])
                sign *= sense[root];
            if (give)
                list->crossings[i].way = vec3d_scale(sums[root], sign);
            else
                sums[root] = vec3d_muladd(sums[root], list->crossings[i].way, sign);
        }
    free(parent);
    free(sense);
    free(sums);
}

/* ---- Free pairs ---- */

static void sort_vertices(uint32_t *v, int count)
{
    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && v[k] < v[k - 1]; k--) {
            uint32_t swapped = v[k];
            v[k] = v[k - 1];
            v[k - 1] = swapped;
        }
}

static uint64_t mix(uint64_t hash, uint32_t number)
{
    hash = (hash ^ number) * 0x9E3779B97F4A7C15u; /* 2^64 / golden ratio */
    return hash ^ (hash >> 29);
}

/* The same for a pair however its features and their vertices are ordered. */
static uint64_t key_of(const struct tl_near_pair *pair)
{
    uint32_t v[4];
    memcpy(v, pair->v, sizeof v);
    if (pair->edges) {
        sort_vertices(v, 2);
        sort_vertices(v + 2, 2);
        if (v[0] > v[2] || (v[0] == v[2] && v[1] > v[3])) {
            const uint32_t swapped[4] = {v[2], v[3], v[0], v[1]};
            memcpy(v, swapped, sizeof v);
        }
    } else
        sort_vertices(v + 1, 3);
    uint64_t hash = pair->edges;
    for (int i = 0; i < 4; i++)
        hash = mix(hash, v[i]);
    return hash;
}

static int compare_keys(const void *a, const void *b)
{
    uint64_t left = *(const uint64_t *)a, right = *(const uint64_t *)b;
    return (left > right) - (left < right);
}

static void add_free(struct tl_untangle *untangle, struct tl_near_pair pair)
{
    if (untangle->free_count == untangle->free_capacity) {
        untangle->free_capacity = 2 * untangle->free_capacity + 64;
        untangle->free_keys = tl_resize(untangle->free_keys, untangle->free_capacity, sizeof(uint64_t));
    }
    untangle->free_keys[untangle->free_count++] = key_of(&pair);
}

/* A crossing comes out where an end of the edge passes the triangle, or the edge one of the triangle's sides.
 */
static void free_crossing(struct tl_untangle *untangle, const struct tl_near *near,
                          const struct crossing *crossing)
{
    const uint32_t *t = near->topology->triangles[crossing->triangle];
    uint32_t e[2];
    edge_of(near, crossing, e);
    for (int i = 0; i < 2; i++)
        add_free(untangle, (struct tl_near_pair){.v = {e[i], t[0], t[1], t[2]}});
    for (int i = 0; i < 3; i++)
        add_free(untangle, (struct tl_near_pair){.v = {e[0], e[1], t[i], t[(i + 1) % 3]}, .edges = true});
}

bool tl_untangle_is_free(const struct tl_untangle *untangle, const struct tl_near_pair *pair)
{
    if (untangle->free_count == 0)
        return false;
    uint64_t key = key_of(pair);
    return bsearch(&key, untangle->free_keys, untangle->free_count, sizeof key, compare_keys) != NULL;
}

/* ---- Search and push ---- */

static void direct(struct tl_untangle *untangle, const struct tl_near *near, const struct crossing_list *list)
{
    size_t count = near->topology->vertex_count;
    double *shares = TL_NEW_ARRAY(double, count);
    untangle->push = tl_resize(untangle->push, count, sizeof *untangle->push);
    memset(untangle->push, 0, count * sizeof *untangle->push);
    for (size_t k = 0; k < list->count; k++) {
        const struct crossing *crossing = &list->crossings[k];
        const uint32_t *t = near->topology->triangles[crossing->triangle];
        uint32_t e[2];
        edge_of(near, crossing, e);
        const uint32_t v[5] = {e[0], e[1], t[0], t[1], t[2]};
        double squared = vec3d_dot(crossing->way, crossing->way);
        vec3d way = vec3d_scale(crossing->way, 1 / sqrt(squared + SOFTENING * SOFTENING));
        for (int i = 0; i < 5; i++) {
            untangle->push[v[i]] = vec3d_muladd(untangle->push[v[i]], way, i < 2 ? 1 : -1);
            shares[v[i]]++;
        }
    }
    for (size_t i = 0; i < count; i++)
        if (shares[i] > 0)
            untangle->push[i] = vec3d_scale(untangle->push[i], 1 / shares[i]);
    free(shares);
}

void tl_untangle_search(struct tl_untangle *untangle, struct tl_near *near, const vec3d *x)
{
    struct tl_near_pairs pairs = {0};
    struct crossing_list list = {0};
    tl_crossings_find(&near->tree, near->topology, x, &pairs);
    for (size_t i = 0; i < pairs.count; i++) {
        add_sides(near, pairs.pairs[i][0], pairs.pairs[i][1], x, &list);
        add_sides(near, pairs.pairs[i][1], pairs.pairs[i][0], x, &list);
    }
    untangle->pair_count = pairs.count;
    untangle->free_count = 0;
    for (size_t k = 0; k < list.count; k++) {
        list.crossings[k].way = way_of(near, &list.crossings[k], x);
        free_crossing(untangle, near, &list.crossings[k]);
    }
    if (untangle->free_count > 0)
        qsort(untangle->free_keys, untangle->free_count, sizeof(uint64_t), compare_keys);
    join_contours(near, &list);
    direct(untangle, near, &list);
    tl_near_pairs_release(&pairs);
    free(list.crossings);
}

void tl_untangle_push(const struct tl_untangle *untangle, double h, struct tl_particles *particles)
{
    for (size_t i = 0; i < particles->count; i++) {
        if (!(particles->w[i] > 0))
            continue;
        particles->x[i] = vec3d_muladd(particles->x[i], untangle->push[i], PUSH_SPEED * h);
        particles->previous[i] = vec3d_muladd(particles->previous[i], untangle->push[i], PUSH_SPEED * h);
    }
}
