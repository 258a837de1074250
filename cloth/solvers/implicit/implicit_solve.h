/* Conjugate gradients for `settle`: (mu + K) d = b, with directions in which a particle may not move.
 *
 * What a particle may not do is filtered out of residuals and search directions (Baraff and Witkin 1998,
 * "Large Steps in Cloth Simulation", section 5.3), so that contact and pins hold exactly at every iteration.
 * The iterates' quadratic energy only falls: where the iteration is cut short, what it has is bounded.
 *
 * Sums are taken over fixed runs of vertices and combined in order: the result does not depend on the number
 * of threads. Units: d m, b N. Threads: uses all. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_IMPLICIT_SOLVE_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_IMPLICIT_SOLVE_H

#include "cloth/solvers/implicit/implicit_factor.h"

/* What a vertex may still do. */
enum tl_freedom {
    TL_MOVES_FREELY,
    TL_MOVES_ACROSS, /* across `direction`: within a plane */
    TL_MOVES_NOT,
};
struct tl_filter {
    enum tl_freedom freedom;
    vec3d direction; /* unit */
};

struct tl_system {
    const struct tl_stiffness *stiffness;
    tl_factor *factor;               /* the preconditioner */
    const double *inertia;           /* [vertex_count] N/m, mu */
    const vec3d *load;               /* [vertex_count] b */
    const struct tl_filter *filters; /* [vertex_count] */
    double tolerance;                /* of the residual, in the preconditioner's norm, to that at the start */
    double floor;                    /* J: squared residuals below need no more work */
    int most_iterations;
};

/* Memory of the iteration. */
struct tl_solve_space {
    size_t vertex_count;
    vec3d *residual, *conditioned, *direction, *product;
    double *sums; /* one a run */
};
struct tl_solve_space tl_solve_space_create(size_t vertex_count);
void tl_solve_space_release(struct tl_solve_space *space);

struct tl_solve_result {
    int iterations;
    bool converged; /* false: cut short */
    double goal;    /* J, what the squared residual had to reach */
};

/* Starts at `step` or at `given`, a step of the filtered parts only, which `step` has too: at the better of
 * the two, by which the goal is measured, so that the error is small against what the forces change, in
 * motion and at rest. Leaves the answer in `step` [vertex_count]. */
struct tl_solve_result tl_solve(const struct tl_system *system, struct tl_solve_space *space,
                                const vec3d *given, vec3d *step);

/* Row `vertex` of (mu + K) d - b: what something must push with (N) for the vertex to move as it does. */
vec3d tl_solve_reaction(const struct tl_system *system, size_t vertex, const vec3d *step);

#endif
