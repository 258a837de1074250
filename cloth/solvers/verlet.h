/* `reference`: velocity Verlet (Stoermer 1907), explicit and symplectic, at 0.9 of the critical step.
 *
 * Second order, keeps momentum to rounding and energy to a ripple of order (omega h)^2, adds no damping of
 * its own: the most exact for its cost. Its price: the step falls with the root of stiffness and with the
 * size of triangles, so a stiff fabric takes thousands of substeps a frame, and beyond
 * cloth.reference_substeps it is refused.
 *
 * Cost: 23 to 25 ns a particle and substep on one core of 3.7 GHz with registers of 512 bits (10,000
 * vertices, two triangles each; 129 ns as plain loops), of which bending and the sum of forces 9,
 * membranes 8. Threads: its loops share the particles out. */
#ifndef TOILE_CLOTH_SOLVERS_VERLET_H
#define TOILE_CLOTH_SOLVERS_VERLET_H

#include "cloth/energy/energy.h"
#include "cloth/mesh/particles.h"

#define TL_VERLET_SAFETY 0.9 /* of the critical step */

/* One substep of h seconds with `forces` (N), which the moves below borrow. */
struct tl_verlet {
    const vec3d *forces;
    double gravity, damping_factor, h; /* m/s^2, share of v that half the substep's drag leaves, s */
};
struct tl_verlet tl_verlet_make(const vec3d *forces, double gravity, double drag, double h);

/* x and v at the substep's start, with the forces at x. v <- v exp(-drag h/2) + h/2 a; previous <- x;
 * x <- x + h v. Then constraints may move x. */
void tl_verlet_drift(struct tl_particles *particles, const struct tl_verlet *substep);

/* What constraints moved x by, over h, is added to v; then v <- (v + h/2 a) exp(-drag h/2), with the forces
 * at the new x: what tl_energy_forces can do as it goes. */
struct tl_particle_kernel tl_verlet_kick(struct tl_particles *particles, const struct tl_verlet *substep);

/* The kick, and the drift of the next substep at once. */
struct tl_particle_kernel tl_verlet_leap(struct tl_particles *particles, const struct tl_verlet *substep);

#endif
