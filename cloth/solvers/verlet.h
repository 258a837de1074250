/* `reference`: velocity Verlet [Stoermer 1907], explicit and symplectic, at 0.9 of the critical step.
 *
 * Second order; conserves momentum to rounding and energy up to a ripple of order (omega h)^2; adds no
 * damping of its own. It is the most exact solver for its cost. Its price: the step is proportional to the
 * size of triangles and to the inverse root of stiffness, so that a stiff fabric takes thousands of substeps
 * a frame; one that needs more than cloth.reference_substeps is refused.
 *
 * Cost: 23 to 25 ns per particle and substep on one core of 3.7 GHz with registers of 512 bits (10,000
 * vertices, two triangles each; 129 ns as plain loops), of which 9 for bending and the sum of forces, 8 for
 * membranes. Threads: its loops divide the particles among all. */
#ifndef TOILE_CLOTH_SOLVERS_VERLET_H
#define TOILE_CLOTH_SOLVERS_VERLET_H

#include "cloth/energy/energy.h"
#include "cloth/mesh/particles.h"

#define TL_VERLET_SAFETY 0.9 /* of the critical step */

/* One substep of h seconds; borrows `forces` (N). */
struct tl_verlet {
    const vec3d *forces;
    double gravity, damping_factor, h; /* m/s^2, share of v that half the substep's drag leaves, s */
};
struct tl_verlet tl_verlet_make(const vec3d *forces, double gravity, double drag, double h);

/* The drift. Given x and v at the substep's start and the forces at x:
 *     v <- v exp(-drag h/2) + h/2 a,   previous <- x,   x <- x + h v.
 * Then constraints may move x. */
void tl_verlet_drift(struct tl_particles *particles, const struct tl_verlet *substep);

/* The kick. Adds (x - drifted x) / h, the effect of constraints, to v; then, with the forces at the new x,
 *     v <- (v + h/2 a) exp(-drag h/2).
 * The two half steps of drag surround the kicks symmetrically, which keeps the scheme of second order. A
 * kernel for tl_energy_forces; borrows `substep`. */
struct tl_particle_kernel tl_verlet_kick(struct tl_particles *particles, const struct tl_verlet *substep);

/* The kick and the next substep's drift in one pass over memory. */
struct tl_particle_kernel tl_verlet_leap(struct tl_particles *particles, const struct tl_verlet *substep);

#endif
