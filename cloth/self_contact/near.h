/* Pairs of the cloth's own features that are near each other: a vertex and a triangle, or two edges.
 *
 * The list is complete while every vertex v stays within reach[v] of base[v], after any one affine motion is
 * taken out of all of them: an affine map takes separate features to separate features. Features that are not
 * listed and that no common vertex joins are then farther apart than `margin`.
 *
 * Most overlapping boxes are those of triangles around one vertex, a hub. Around a hub, features that do not
 * touch are at least `clear` apart at the time of a measurement, and at least clear - 2 s while no spoke
 * (neighbour - hub) has changed by more than s, up to one rotation of all. A hub is open while that exceeds
 * what its vertices can reach; pairs of its triangles then need no test.
 *
 * Vertices that an open seam joins count as one. Metres. Errors: none. Lifetime: a plain struct that owns its
 * arrays; the topology must outlive it. Threads: one call at a time; results do not depend on the number of
 * threads. */
#ifndef TOILE_CLOTH_SELF_CONTACT_NEAR_H
#define TOILE_CLOTH_SELF_CONTACT_NEAR_H

#include "cloth/self_contact/near_tree.h"

#include <stdbool.h>

/* A vertex v[0] and a triangle v[1] v[2] v[3], or the edges v[0] v[1] and v[2] v[3]. */
struct tl_near_pair {
    uint32_t v[4];
    float distance; /* m when listed; a lower bound (tl_closest_segment_bounds) */
    float kept;     /* m, for the list's user; negative when listed */
    bool edges;
};

/* The first vertex of a pair's second feature. */
static inline int tl_near_second(const struct tl_near_pair *pair)
{
    return pair->edges ? 2 : 1;
}

struct tl_near {
    const struct tl_topology *topology;
    struct tl_near_tree tree;
    uint32_t *class_of; /* [vertex] equal for vertices that count as one */
    uint8_t *owns;      /* [triangle] bit i: its corner i is this triangle's; bit 3 + i: the side facing it */
    struct tl_fans fans;  /* corners of triangles around each vertex */
    double *clear;        /* [vertex] m, at the last measurement; 0: not measured */
    uint32_t *ring_first; /* [vertex + 1] */
    uint32_t *ring;       /* of v: ring[ring_first[v]] to ring[ring_first[v + 1] - 1], its neighbours */
    uint32_t *across;     /* [vertex] the ring's entry whose spoke is most nearly across the first */
    vec3d *spokes;        /* [ring entry] in the hub's axes, at the last measurement */
    bool *open;           /* [vertex] */
    double *ranges;       /* [triangle] m, the largest reach of its corners */
    float (*at)[3];       /* [vertex] m from vertex 0, rounded */
    float rounding;       /* m, of a distance of two points of `at` */
    bool listed;          /* base, reach, margin and pairs are valid */
    vec3d *base;          /* [vertex] m */
    double *reach;        /* [vertex] m */
    double margin;        /* m */
    size_t pair_count, pair_capacity;
    struct tl_near_pair *pairs;
};

/* `class_of` [vertex] is copied. */
struct tl_near tl_near_create(const struct tl_topology *topology, const uint32_t *class_of, const vec3d *x);
void tl_near_release(struct tl_near *near);

/* Lists the pairs at positions `x`, good within near->reach, which the caller has filled, and near->margin.
 */
void tl_near_list(struct tl_near *near, const vec3d *x);

/* The nearest points of a pair's two features: weights[0..3] of its vertices, those of each feature sum to 1.
 * Returns the vector from the first point to the second. */
vec3d tl_near_closest(const struct tl_near_pair *pair, const vec3d *x, double weights[4]);

#endif
