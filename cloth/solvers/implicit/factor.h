/* The preconditioner of `settle`: a Cholesky factor of
 *     M / h^2 + sum over membranes of A [ (k_weft + k_shear) c c^T + (k_warp + k_shear) d d^T ] + bending +
 * links, which is the stiffness with every resistance acting in all directions (the global matrix of Bouaziz
 * et al. 2014, "Projective Dynamics"). It is the same for x, y and z and does not change while the material
 * and the step do not: factored once, by CHOLMOD, without BLAS, so that it is the same at any number of
 * threads.
 *
 * Branches of its elimination tree are solved side by side, always the same ones, so that what they add up to
 * does not depend on the threads either.
 *
 * Ownership: owns its factor. Threads: a solve uses all; one at a time. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_FACTOR_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_FACTOR_H

#include "cloth/solvers/implicit/stiffness.h"

typedef struct tl_factor tl_factor;

/* Bending is read from `stiffness`. Held particles (inverse mass 0) are left out. `h` in seconds. */
tl_factor *tl_factor_create(const struct tl_energy *energy, const struct tl_cloth_fabric *fabric,
                            const struct tl_springs *springs, const struct tl_stiffness *stiffness,
                            const double *inverse_masses, double h);
void tl_factor_destroy(tl_factor **factor);

/* z = P^-1 r, both [vertex_count]. */
void tl_factor_solve(tl_factor *factor, const vec3d *r, vec3d *z);

#endif
