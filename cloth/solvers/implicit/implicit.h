/* `settle`: backward Euler with one linearised step [Baraff and Witkin 1998]: (mu + K) d = mu (y - x) + f(x),
 * mu = m (1 + drag h) / h^2,   y = x + (h v + h^2 g) / (1 + drag h), for the step d, by preconditioned
 * conjugate gradients (conjugate_gradient.h). What the cloth comes to rest at does not depend on the step: it
 * is the exact equilibrium. The state stays finite for any stiffness and step.
 *
 * The price: the scheme is of first order in h and damps motion, the more the faster it oscillates, so that a
 * swing dies sooner than it should.
 *
 * Contact planes are enforced within the solve: contact_constraint.h for particles, penalty_contact.h for
 * samples.
 *
 * Energy guard: if the sum of kinetic, elastic and gravitational energy would rise, the step is linearised
 * again at its end (Newton's method); if that does not help, it is shortened. Threads: uses all; one step at
 * a time. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_IMPLICIT_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_IMPLICIT_H

#include "cloth/solvers/implicit/conjugate_gradient.h"
#include "cloth/solvers/implicit/contact_constraint.h"
#include "cloth/solvers/implicit/penalty_contact.h"

/* The pull of tl_cloth_grab: a spring to a target, with a bounded force. */
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
    /* Iterations that further rounds of contact may take, relative to the first round's, plus a fixed
     * minimum. */
    double contact_budget;
    double tolerance; /* of conjugate gradients: residual at the end, relative to the start */
    int max_iterations;
};

/* Counters over steps. */
struct tl_implicit_tally {
    size_t steps, iterations;
    size_t unconverged; /* steps whose iterations were cut short */
    size_t shortened;   /* steps that the guard shortened */
};

typedef struct tl_implicit tl_implicit;

/* For steps with this problem's material, number of springs and h. Copies what it needs. End with
 * tl_implicit_destroy, which sets the handle to NULL and ignores NULL. */
tl_implicit *tl_implicit_create(const struct tl_implicit_problem *problem,
                                const struct tl_particles *particles);
void tl_implicit_destroy(tl_implicit **handle);

/* Computes x from `previous` and v. Held particles (w = 0) must be at their new x already. Leaves velocities
 * unchanged. Adds to `tally`. */
void tl_implicit_step(tl_implicit *implicit, const struct tl_implicit_problem *problem,
                      struct tl_particles *particles, struct tl_implicit_tally *tally);

#endif
