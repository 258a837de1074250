/* `preview`: one substep of XPBD (Macklin, Mueller, Chentanez 2016; one iteration per substep, Macklin et al.
 * 2019, "Small Steps in Physics Simulation"): predict, solve each constraint once in a fixed order, take the
 * velocity from the motion. With a fresh multiplier each substep a single spring is exactly implicit Euler.
 *
 * Bounded cost, finite for any stiffness and step. Its price: at rest it hangs as if it were softer, by a
 * share that shrinks with the substep, and stiff motion is damped. Serial Gauss-Seidel over batches whose
 * elements share no vertex: the result depends neither on the number of threads nor on how wide the processor
 * is. Threads: pure.
 */
#ifndef TOILE_CLOTH_XPBD_H
#define TOILE_CLOTH_XPBD_H

#include "cloth/energy.h"
#include "cloth/particles.h"

/* Every membrane, bend and link once. */
void tl_xpbd_solve(const struct tl_energy *energy, struct tl_particles *particles);
void tl_xpbd_solve_link(const struct tl_link *link, struct tl_particles *particles);

#endif
