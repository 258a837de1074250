/* The stiffness matrix of `settle`: K = -d forces / d positions, made positive semidefinite.
 *
 * Membranes and links give 3 x 3 blocks that depend on the shape. A stretch k/2 (|F| - 1)^2 with n = F/|F|
 * gives k [ n n^T + max(1 - 1/|F|, 0) (I - n n^T) ], exact under tension; in compression the term across n
 * would be negative (real cloth buckles) and make K indefinite, so it is left out [Choi and Ko 2002]. Shear
 * gives its Gauss-Newton part k g g^T. Bending is quadratic in the positions: one number per pair of
 * vertices, the same for x, y and z, constant and exact.
 *
 * Rows are gathered by vertex, so that sums do not depend on the threads. Units N/m. Lifetime: plain structs
 * that own their arrays. Threads: assembly uses all; one call at a time. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_STIFFNESS_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_STIFFNESS_H

#include "cloth/energy/energy.h"

/* Loops over at most this many vertices are serial: they end before other threads have woken up. */
#define TL_PARALLEL_ROWS 1000

/* Compressed rows: those of vertex v are entries first[v] to first[v + 1] - 1, columns rising. */
struct tl_sparse_rows {
    uint32_t *first;   /* [vertex_count + 1] */
    uint32_t *columns; /* [first[vertex_count]] */
};

/* The elements around each vertex, and the entries of its row that their blocks are added to. */
struct tl_gather {
    struct tl_fans fans; /* of element corners */
    uint32_t *slots;     /* [fan item][corners of the element]: entry of the row */
};

struct tl_stiffness {
    size_t vertex_count;
    struct tl_sparse_rows blocks, bends;
    struct tl_gather gather;               /* of membranes, by lanes, then links */
    double (*values)[9];                   /* [blocks] row by row */
    double *bend_values;                   /* [bends] */
    size_t element_count;                  /* lanes of membranes, and links */
    struct tl_element_stiffness *elements; /* [element_count] of the current shape */
};

/* Springs besides the energy's own links: seams that are closing. Borrows its links. */
struct tl_springs {
    size_t count;
    const struct tl_link *links;
    double stiffness; /* N/m, of each */
};

/* Builds the sparsity pattern and bending's entries. */
struct tl_stiffness tl_stiffness_build(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                                       const struct tl_springs *springs, size_t vertex_count);
void tl_stiffness_release(struct tl_stiffness *stiffness);

/* Computes the blocks at positions x, for as many springs as it was built with. */
void tl_stiffness_assemble(struct tl_stiffness *stiffness, const struct tl_energy *energy,
                           const struct tl_cloth_fabric *fabric, const struct tl_springs *springs,
                           const vec3d *x);

/* Adds scale n n^T to the block of two vertices of a triangle. */
void tl_stiffness_add(struct tl_stiffness *stiffness, uint32_t row, uint32_t column, vec3d n, double scale);

/* Row `vertex` of the product with p. */
vec3d tl_stiffness_row(const struct tl_stiffness *stiffness, size_t vertex, const vec3d *p);

#endif
