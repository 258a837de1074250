/* Sparse L D L^T by Eigen's simplicial Cholesky (MPL-2), behind a C interface.
 *
 * Simplicial and single-threaded: without BLAS and without supernodes its sums have one order, so the factor
 * is the same to the bit at any number of threads. Threads: pure. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_FACTOR_SHIM_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_FACTOR_SHIM_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One term of a matrix entry: entries of the same place add up. */
struct tl_triplet {
    int row, column; /* of the lower triangle: row >= column */
    double value;
};

/* P A P^T = L D L^T with a unit lower triangular L: column j has the rows rows[first[j]] to
 * rows[first[j + 1] - 1], rising and below j, with `values`. */
struct tl_sparse_factor {
    size_t count;
    int *order;     /* [count] the row of A that became row j: P */
    int *first;     /* [count + 1] */
    int *rows;      /* [first[count]] */
    double *values; /* [first[count]] */
    double *pivots; /* [count] D */
};

/* Factorises the symmetric matrix of `count` rows whose lower triangle is the sum of `triplets`, in the order
 * that AMD finds [Amestoy et al. 1996], which keeps L sparse. Every pivot that comes out below
 * `min_pivot` is raised to it. False when it does not fit into memory or a pivot is not a finite number;
 * `out` is then empty. */
bool tl_sparse_factor_create(size_t count, const struct tl_triplet *triplets, size_t triplet_count,
                             double min_pivot, struct tl_sparse_factor *out);
void tl_sparse_factor_release(struct tl_sparse_factor *factor);

#ifdef __cplusplus
}
#endif

#endif
