/* The preconditioner of `settle`: a sparse L D L^T factor of
 *     P = M / h^2 + sum over membranes of A [ (k_weft + k_shear) c c^T + (k_warp + k_shear) d d^T ] + bending
 * + links, the stiffness matrix with every resistance acting in all directions (the global matrix of [Bouaziz
 * et al. 2014]). It is the same for x, y and z and constant while the material and the step are, so it is
 * factorised once, by Eigen (factor_shim.h), and solved in every iteration, here.
 *
 * Branches of the elimination tree are solved in parallel. The split into branches is fixed, and so is the
 * order in which their contributions to the common top are summed: results do not depend on the number of
 * threads.
 *
 * Lifetime: owns its arrays. Threads: a solve uses all; one solve at a time, as it has scratch space. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_FACTOR_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_FACTOR_H

#include "cloth/solvers/implicit/stiffness.h"

typedef struct tl_factor tl_factor;

/* Factorises for a step of `h` seconds; bending is read from `stiffness`, held particles (inverse mass 0) are
 * left out. End with tl_factor_destroy, which sets the handle to NULL and ignores NULL. */
tl_factor *tl_factor_create(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                            const struct tl_springs *springs, const struct tl_stiffness *stiffness,
                            const double *inverse_masses, double h);
void tl_factor_destroy(tl_factor **factor);

/* Solves P z = r; both [vertex_count]. */
void tl_factor_solve(tl_factor *factor, const vec3d *r, vec3d *z);

#endif
