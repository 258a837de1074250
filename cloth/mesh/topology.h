/* Connectivity of welded triangle meshes, from sorted edge lists.
 *
 * Real garments and bodies are not manifold: edges with three triangles, triangles given twice, slivers.
 * Nothing here asks for more than a list of triangles; an edge is a hinge only where exactly two triangles
 * meet. Ownership: plain struct that owns its arrays. Threads: pure. */
#ifndef TOILE_CLOTH_MESH_TOPOLOGY_H
#define TOILE_CLOTH_MESH_TOPOLOGY_H

#include <cglm/struct.h>

#include <stddef.h>
#include <stdint.h>

#define TL_NONE UINT32_MAX

/* Physics vertex of every render vertex, by bitwise equal position (-0 equals 0); returns how many there are.
 * Numbers rise in order of first appearance. */
size_t tl_weld_positions(const vec3s *positions, size_t count, uint32_t *weld);

struct tl_topology {
    size_t vertex_count;      /* welded vertices */
    size_t render_count;      /* render vertices */
    uint32_t *weld;           /* [render_count] welded vertex of each */
    size_t triangle_count;    /* triangles with three different corners, each set of corners once */
    uint32_t (*triangles)[3]; /* welded vertices, winding as in the file */
    uint32_t *source;         /* [triangle_count] index of the triangle in the render mesh */
    uint32_t (*neighbour)[3]; /* triangle across the edge that faces corner i, TL_NONE where there is not
                                 exactly one */
    size_t edge_count;
    uint32_t (*edges)[2]; /* each once, lower vertex first, sorted */
};

/* `weld` has render_count entries below vertex_count; `indices` are render vertices. */
struct tl_topology tl_topology_build(const uint32_t *indices, size_t index_count, const uint32_t *weld,
                                     size_t render_count, size_t vertex_count);
void tl_topology_release(struct tl_topology *topology);

/* The edge between two vertices that have one. */
uint32_t tl_topology_edge(const struct tl_topology *topology, uint32_t a, uint32_t b);

/* Corner (0 to 2) of `neighbour` that `triangle` does not have: the far corner of their hinge. */
uint32_t tl_topology_far_corner(const struct tl_topology *topology, uint32_t triangle, uint32_t neighbour);

/* Lists of the elements around each vertex: those of v are items[first[v]] to items[first[v + 1] - 1], in
 * rising order. `corners` has corner_count entries; item i belongs to element i / per_element. */
struct tl_fans {
    uint32_t *first; /* [vertex_count + 1] */
    uint32_t *items; /* [corner_count]: positions in `corners` */
};
struct tl_fans tl_fans_build(const uint32_t *corners, size_t corner_count, size_t vertex_count);
void tl_fans_release(struct tl_fans *fans);

/* Batches of TL_BATCH elements that share no vertex, so that a batch can be solved as one: greedy colours,
 * one after the other, each in the order given. A run is batches that share no vertex either: those of a
 * colour. */
#define TL_BATCH 8
struct tl_batches {
    size_t count, run_count;
    uint32_t *elements; /* [count][TL_BATCH] numbers; TL_NONE in lanes that stay empty */
    size_t *run_ends;   /* [run_count] the batch after each run's last */
};
/* Element i has `per_element` vertices at corners + i * stride. */
struct tl_batches tl_batches_build(const uint32_t *corners, size_t stride, size_t per_element, size_t count,
                                   size_t vertex_count);
void tl_batches_release(struct tl_batches *batches);

/* Disjoint sets with the lowest member as the representative of each. */
uint32_t tl_sets_find(uint32_t *parents, uint32_t member);
void tl_sets_join(uint32_t *parents, uint32_t a, uint32_t b);

#endif
