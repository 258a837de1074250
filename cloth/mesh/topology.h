/* Connectivity of welded triangle meshes, from sorted edge lists.
 *
 * Real garments and bodies are not manifold: they have edges with three triangles, repeated triangles and
 * slivers. So the input may be any list of triangles; an edge is a hinge only if exactly two triangles share
 * it. Lifetime: plain structs that own their arrays. Threads: pure. */
#ifndef TOILE_CLOTH_MESH_TOPOLOGY_H
#define TOILE_CLOTH_MESH_TOPOLOGY_H

#include <cglm/struct.h>

#include <stddef.h>
#include <stdint.h>

#define TL_NONE UINT32_MAX

/* Welds vertices of bitwise equal position (-0 equals 0): writes the physics vertex of every render vertex to
 * `weld` [count], numbered in order of first appearance, and returns the number of physics vertices. */
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

/* Builds the topology of the welded mesh. `indices` are render vertices, three per triangle; `weld` has
 * render_count entries below vertex_count. */
struct tl_topology tl_topology_build(const uint32_t *indices, size_t index_count, const uint32_t *weld,
                                     size_t render_count, size_t vertex_count);
void tl_topology_release(struct tl_topology *topology);

/* Index of the edge between two vertices that are known to share one. */
uint32_t tl_topology_edge(const struct tl_topology *topology, uint32_t a, uint32_t b);

/* The far corner of a hinge: the corner (0 to 2) of `neighbour` that is not a vertex of `triangle`. */
uint32_t tl_topology_far_corner(const struct tl_topology *topology, uint32_t triangle, uint32_t neighbour);

/* Lists of the elements around each vertex: those of v are items[first[v]] to items[first[v + 1] - 1], in
 * rising order. `corners` has corner_count entries; item i belongs to element i / per_element. */
struct tl_fans {
    uint32_t *first; /* [vertex_count + 1] */
    uint32_t *items; /* [corner_count]: positions in `corners` */
};
struct tl_fans tl_fans_build(const uint32_t *corners, size_t corner_count, size_t vertex_count);
void tl_fans_release(struct tl_fans *fans);

/* Batches of TL_BATCH elements that share no vertex, so that their constraints can be solved simultaneously.
 * Elements are coloured greedily in the order given; a batch has one colour. A run is a sequence of batches
 * that share no vertex either, namely those of one colour. */
#define TL_BATCH 8
struct tl_batches {
    size_t count, run_count;
    uint32_t *elements; /* [count][TL_BATCH] numbers; TL_NONE in lanes that stay empty */
    size_t *run_ends;   /* [run_count] one past the last batch of each run */
};
/* Element i has `per_element` vertices at corners + i * stride. */
struct tl_batches tl_batches_build(const uint32_t *corners, size_t stride, size_t per_element, size_t count,
                                   size_t vertex_count);
void tl_batches_release(struct tl_batches *batches);

#endif
