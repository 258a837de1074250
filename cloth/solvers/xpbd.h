/* `preview`: XPBD [Macklin et al. 2016] with one iteration per substep [Macklin et al. 2019]: predict
 * positions, solve each constraint once in a fixed order, derive velocities from displacements. The
 * multiplier starts at 0 in each substep, so that a single spring is exactly implicit Euler.
 *
 * Bending is an explicit force in the prediction if the substep is at most 0.55 of bending's own critical
 * step, which holds for clothes in their usual mesh and substeps: it then bends exactly as the energy says,
 * at a third of the cost. Otherwise it is a constraint of three rows like the others.
 *
 * The cost is bounded, and the state stays finite for any stiffness and step. The price: cloth at rest is
 * stretched as if it were softer, by a share that shrinks with the substep, unless it is prestressed
 * (tl_energy_set_prestress), and stiff motion is damped.
 * Gauss-Seidel over batches whose elements share no vertex, colour by colour: the result depends neither on
 * the number of threads nor on the width of the registers.
 *
 * Cost: 26 to 28 ns per particle and substep away from the strain limit on one core of 3.7 GHz with registers
 * of 512 bits (10,000 vertices, two triangles each; 98 ns as plain loops of four lanes), of which 15 for
 * membranes, 8 for bending as a force; up to 6 more for the strain limit while much of the cloth is near it;
 * 25 more where bending is a constraint. Threads: divides the batches among all; one solve at a time per
 * energy. */
#ifndef TOILE_CLOTH_SOLVERS_XPBD_H
#define TOILE_CLOTH_SOLVERS_XPBD_H

#include "cloth/energy/energy.h"
#include "cloth/mesh/particles.h"

/* Marks the membranes in which some direction is stretched to more than sqrt(max) times its rest length. */
struct tl_stretch_watch {
    double max;
    bool (*seen)[TL_BATCH]; /* [membrane_count] batches */
};

/* Solves every membrane, bend and link once; `watch`, if not NULL, receives what the strain limit needs. */
void tl_xpbd_solve(const struct tl_energy *energy, struct tl_particles *particles,
                   const struct tl_stretch_watch *watch);
/* The same in the opposite order, at five times the cost: the second half of a symmetric sweep. */
void tl_xpbd_solve_backward(const struct tl_energy *energy, struct tl_particles *particles);

/* The step (s) that tl_energy_set_preview must be given for substeps of h seconds.
 *
 * Why meshes of needles need a symmetric sweep: solving one constraint is a projection in the metric of the
 * masses, in the linear case a symmetric map with eigenvalues in (0, 1]. One sweep is a product A of such
 * maps, which is not symmetric, and for a complex eigenvalue a of A the substep's z^2 - 2 a z + a = 0 may
 * leave the unit circle. On meshes of needles, where stretch and shear share no directions, that was seen to
 * grow. A sweep forwards and one backwards is A A^T, which is symmetric: then |z|^2 = a <= 1, stable at any
 * step. Each constraint is solved twice then, so each solve gets half its stiffness, which is a step shorter
 * by sqrt(2). */
static inline double tl_xpbd_step(double h, bool symmetric)
{
    return symmetric ? h / M_SQRT2 : h;
}
/* Solves one link. */
void tl_xpbd_solve_link(const struct tl_link *link, struct tl_particles *particles);

#endif
