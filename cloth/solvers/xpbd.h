/* `preview`: one substep of XPBD (Macklin, Mueller, Chentanez 2016; one iteration per substep, Macklin et al.
 * 2019, "Small Steps in Physics Simulation"): predict, solve each constraint once in a fixed order, take the
 * velocity from the motion. With a fresh multiplier each substep a single spring is exactly implicit Euler.
 *
 * Bending is an explicit force in the prediction where the substep is no more than 0.7 of bending's own
 * critical step, which it is for clothes in their usual mesh and substeps: it then bends exactly as much as
 * the energy says, and at a third of the cost. Else it is a constraint of three rows like the others.
 *
 * Bounded cost, finite for any stiffness and step. Its price: at rest it stretches as if it were softer, by a
 * share that shrinks with the substep, and stiff motion is damped. Gauss-Seidel over batches whose elements
 * share no vertex, by colours: the result depends neither on the number of threads nor on how wide the
 * processor is.
 *
 * Cost: 26 to 28 ns a particle and substep away from the strain limit on one core of 3.7 GHz with registers
 * of 512 bits (10,000 vertices, two triangles each; 98 ns as plain loops of four lanes), of which membranes
 * 15, bending as a force 8; up to 6 more for the strain limit while much of the cloth is near it; 25 more
 * when bending is a constraint.
 */
#ifndef TOILE_CLOTH_SOLVERS_XPBD_H
#define TOILE_CLOTH_SOLVERS_XPBD_H

#include "cloth/energy/energy.h"
#include "cloth/mesh/particles.h"

/* Which membranes were found stretched so that F turns something into more than sqrt(most) times its length.
 */
struct tl_stretch_watch {
    double max;
    bool (*seen)[TL_BATCH]; /* [membrane_count] batches */
};

/* Every membrane, bend and link once; `watch` may be NULL. */
void tl_xpbd_solve(const struct tl_energy *energy, struct tl_particles *particles,
                   const struct tl_stretch_watch *watch);
/* The same in the opposite order, and at five times the cost: see tl_xpbd_step. */
void tl_xpbd_solve_backward(const struct tl_energy *energy, struct tl_particles *particles);

/* Solving a constraint is the nearest point in the metric of the masses, a symmetric map in the linear case
 * with eigenvalues in (0, 1]. One sweep is a product of such maps A, which is not symmetric: complex
 * eigenvalues a of A make the substep's z^2 - 2 a z + a = 0 leave the unit circle, and on meshes of needles,
 * where stretch and shear share no directions, that was seen to grow. Forth and back again is A A^T,
 * symmetric: |z|^2 = a <= 1, stable at any step. Each constraint is then solved twice, so with half its
 * stiffness: the step (s) that tl_energy_set_preview is to be given. */
static inline double tl_xpbd_step(double h, bool back)
{
    return back ? h / M_SQRT2 : h;
}
void tl_xpbd_solve_link(const struct tl_link *link, struct tl_particles *particles);

#endif
