/* The membranes as `preview` solves them: by two that share an edge, one after the other while their four
 * vertices are at hand, which halves the way to memory of the edge's ends. What finds no partner stays alone.
 *
 * Units as in energy.h. Threads: pure. */
#ifndef TOILE_CLOTH_PAIRS_H
#define TOILE_CLOTH_PAIRS_H

#include "cloth/cloth.h"
#include "cloth/topology.h"
#include "config/memory.h"

struct tl_membrane;

/* One membrane of each lane's pair: F_u = c_0 (x_1 - x_0) + c_1 (x_2 - x_0), F_v with d. Its vertices are the
 * pair's first two and one of the others. A missing one has zeros. */
struct tl_side {
    double c[2][TL_BATCH], d[2][TL_BATCH];           /* 1/m */
    double cc[TL_BATCH], cd[TL_BATCH], dd[TL_BATCH]; /* sums of w c_i c_i, ...: fixed while masses are */
    double weft[TL_BATCH], warp[TL_BATCH];           /* -1 / (w |grad|^2 + 1 / (k A h^2)) */
    double shear[TL_BATCH];                          /* 1 / (k A h^2) */
};

/* A batch: all that a substep reads, as it waits for memory. */
#define TL_SIDES 2
struct tl_pair {
    _Alignas(TL_CACHE_LINE) struct tl_side sides[TL_SIDES];
    double w[4][TL_BATCH];          /* 1/kg, of the vertices */
    uint32_t vertices[4][TL_BATCH]; /* the shared edge's ends, then the first side's third, the second's */
};

struct tl_pairs {
    size_t count, run_count, *run_ends; /* batches; see struct tl_batches */
    struct tl_pair *batches;
    uint32_t (*membranes)[TL_SIDES][TL_BATCH]; /* [count] numbers of membranes; TL_NONE for a missing one */
};

/* Of the membranes of `triangles` [count], numbered in this order, lane after lane. */
struct tl_pairs tl_pairs_build(const struct tl_topology *topology, const struct tl_membrane *membranes,
                               const uint32_t *triangles, size_t count);
void tl_pairs_release(struct tl_pairs *pairs);

/* Material, substep `h` seconds and inverse masses [vertex_count + 1]. */
void tl_pairs_set(struct tl_pairs *pairs, const struct tl_membrane *membranes,
                  const struct tl_cloth_fabric *fabric, const double *inverse_masses, double h);

#endif
