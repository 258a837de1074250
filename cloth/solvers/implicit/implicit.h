/* `settle`: backward Euler with one linearised step (Baraff and Witkin 1998, "Large Steps in Cloth
 * Simulation"): (mu + K) d = mu (y - x) + f(x),   mu = m (1 + drag h) / h^2,   y = x + (h v + h^2 g) / (1 +
 * drag h) by conjugate gradients (cloth/solvers/implicit/conjugate_gradient.h). What it comes to rest at does
 * not depend on the step: it is the exact equilibrium. Any stiffness and step stay finite.
 *
 * Its price: motion is damped by the step, the more the quicker it is, so a swing dies sooner than it should;
 * of first order in h.
 *
 * Contact (cloth/solvers/implicit/contact_constraint.h, cloth/solvers/implicit/penalty_contact.h): planes are
 * heeded while solving.
 *
 * Guard: where kinetic, elastic and gravity's energy together would rise, the step is linearised again at its
 * end (Newton's method); if that does not help, it is shortened. Threads: uses all. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_IMPLICIT_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_IMPLICIT_H

#include "cloth/solvers/implicit/conjugate_gradient.h"
#include "cloth/solvers/implicit/contact_constraint.h"
#include "cloth/solvers/implicit/penalty_contact.h"

/* The hand: a spring to a target with a bounded force. */
struct tl_hand {
    uint32_t particle; /* TL_NONE: none */
    vec3d target;
    double stiffness, max_force; /* N/m, N */
};

/* One substep. */
struct tl_implicit_problem {
    const struct tl_energy *energy;
    const struct tl_cloth_fabric *fabric;
    struct tl_springs springs; /* as many as in the last tl_implicit_create */
    struct tl_hand hand;
    struct tl_contacts *contacts;
    struct tl_contact_params contact;
    double gravity, drag, h;
    double
        contact_budget; /* what further rounds of contact may take, as a share of the first; and a few more */
    double tolerance;   /* of conjugate gradients */
    int max_iterations;
};

/* What steps took. */
struct tl_implicit_tally {
    size_t steps, iterations;
    size_t unconverged; /* steps whose iterations were cut short */
    size_t shortened;   /* steps that the guard shortened */
};

typedef struct tl_implicit tl_implicit;

/* For steps of this problem's material, springs and h. */
tl_implicit *tl_implicit_create(const struct tl_implicit_problem *problem,
                                const struct tl_particles *particles);
void tl_implicit_destroy(tl_implicit **handle);

/* From particles->previous and v to x; held particles (w = 0) are at their new x already. Velocities are
 * left. Adds to `tally`. */
void tl_implicit_step(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                      struct tl_particles *particles, struct tl_implicit_tally *tally);

#endif
