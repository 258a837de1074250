/* Dynamic relaxation: motion towards balance with masses that are not the cloth's [Barnes 1999].
 *
 * At rest masses do not matter, so each vertex gets the one with which an explicit step of h seconds is just
 * stable there: w_i = 4 / (h^2 sum_j |K_ij|), by Gershgorin's theorem on the rows of the stiffness K. All
 * waves then travel about one edge a step, however stiff the fabric, fine the mesh or light the vertex is.
 *
 * Drag takes the energy away. It is small, so that long waves keep their way; short ones, which contact
 * excites, die by inner friction (tl_particles_damp). Stops at peaks of kinetic energy, as in the paper, do
 * worse: contact takes energy at most steps, and so makes a peak of each. */
#ifndef TOILE_CLOTH_SOLVERS_RELAXATION_H
#define TOILE_CLOTH_SOLVERS_RELAXATION_H

#include "cloth/mesh/particles.h"

/* The step: previous <- x, v <- keep v + h w (f + load), x <- x + h v, for the vertices that are not held. */
struct tl_relaxation {
    const vec3d *forces; /* N, elastic */
    const vec3d *loads;  /* N, weights */
    double keep;         /* share of v that drag leaves */
    double h;            /* s */
};
/* Borrows both arguments. */
struct tl_particle_kernel tl_relaxation_kernel(struct tl_particles *particles,
                                               const struct tl_relaxation *relaxation);

/* The inverse masses [vertex_count] from the row sums of |K|, N/m; 0 where `held` is: a vertex without
 * inverse mass, or one that nothing pulls. */
void tl_relaxation_masses(const double *sums, const double *held, size_t vertex_count, double h,
                          double *inverse_masses);

#endif
