/* Conjugate gradients for `settle`: (mu + K) d = b, with directions in which a particle may not move.
 *
 * What a particle may not do is filtered out of residuals and search directions (Baraff and Witkin 1998,
 * "Large Steps in Cloth Simulation", section 5.3), so that contact and pins hold exactly at every iteration.
 * The iterates' quadratic energy only falls: where the iteration is cut short, what it has is bounded.
 *
 * Sums are taken over fixed runs of vertices and combined in order: the result does not depend on the number
 * of threads. Units: d m, b N. Threads: uses all. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_CONJUGATE_GRADIENT_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_CONJUGATE_GRADIENT_H

#include "cloth/solvers/implicit/factor.h"

/* What a vertex may still do. */
enum tl_degrees_of_freedom {
    TL_DOF_ALL,
    TL_DOF_TANGENTIAL, /* across `direction`: within a plane */
    TL_DOF_NONE,
};
struct tl_motion_filter {
    enum tl_degrees_of_freedom allowed;
    vec3d direction; /* unit */
};

struct tl_linear_system {
    const struct tl_stiffness *stiffness;
    tl_factor *factor;                      /* the preconditioner */
    const double *inertia;                  /* [vertex_count] N/m, mu */
    const vec3d *load;                      /* [vertex_count] b */
    const struct tl_motion_filter *filters; /* [vertex_count] */
    double tolerance; /* of the residual, in the preconditioner's norm, to that at the start */
    double floor;     /* J: squared residuals below need no more work */
    int max_iterations;
};

/* Memory of the iteration. */
struct tl_conjugate_gradient_space {
    size_t vertex_count;
    vec3d *residual, *conditioned, *direction, *product;
    double *sums; /* one a run */
};
struct tl_conjugate_gradient_space tl_conjugate_gradient_space_create(size_t vertex_count);
void tl_conjugate_gradient_space_release(struct tl_conjugate_gradient_space *space);

struct tl_conjugate_gradient_result {
    int iterations;
    bool converged; /* false: cut short */
    double goal;    /* J, what the squared residual had to reach */
};

/* Starts at `step` or at `given`, a step of the filtered parts only, which `step` has too: at the better of
 * the two, by which the goal is measured, so that the error is small against what the forces change, in
 * motion and at rest. Leaves the answer in `step` [vertex_count]. */
struct tl_conjugate_gradient_result tl_conjugate_gradient_solve(const struct tl_linear_system *system,
                                                                struct tl_conjugate_gradient_space *space,
                                                                const vec3d *prescribed, vec3d *step);

/* Row `vertex` of (mu + K) d - b: what something must push with (N) for the vertex to move as it does. */
vec3d tl_reaction_at(const struct tl_linear_system *system, size_t vertex, const vec3d *step);

#endif
