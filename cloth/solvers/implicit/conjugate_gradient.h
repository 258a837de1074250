/* Conjugate gradients of `settle`: (mu + K) d = b, where contact and pins remove degrees of freedom.
 *
 * Removed directions are filtered out of residuals and search directions [Baraff and Witkin 1998, 5.3], so
 * that contact and pins hold exactly in every iterate. The quadratic energy of the iterates decreases
 * monotonically: a solve that is cut short still returns a bounded step.
 *
 * Sums are taken over fixed runs of vertices and combined in order, so that the result does not depend on the
 * number of threads. Units: d m, b N. Threads: uses all; one solve at a time per workspace. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_CONJUGATE_GRADIENT_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_CONJUGATE_GRADIENT_H

#include "cloth/solvers/implicit/factor.h"

/* The degrees of freedom that contact and pins leave a vertex. */
enum tl_degrees_of_freedom {
    TL_DOF_ALL,
    TL_DOF_TANGENTIAL, /* orthogonal to `direction` */
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
    double tolerance; /* residual at the end relative to the start, in the preconditioner's norm */
    double floor;     /* J: squared residual that is small enough in any case */
    int max_iterations;
};

/* Workspace of the iteration; owns its arrays. */
struct tl_conjugate_gradient_space {
    size_t vertex_count;
    vec3d *residual, *conditioned, *direction, *product;
    double *sums; /* one a run */
};
struct tl_conjugate_gradient_space tl_conjugate_gradient_space_create(size_t vertex_count);
void tl_conjugate_gradient_space_release(struct tl_conjugate_gradient_space *space);

struct tl_conjugate_gradient_result {
    int iterations;
    bool converged; /* false: stopped at max_iterations */
    double goal;    /* J, the squared residual at which it stops */
};

/* Solves for `step` [vertex_count], which on entry is an initial guess that agrees with `prescribed` in all
 * filtered directions; `prescribed` is a second guess, whose free part is 0. The iteration starts at the
 * better of the two, and the tolerance is relative to that one's residual. So the error is small compared
 * with what the forces change in the step, in motion and at rest; relative to a poor guess it would mean
 * little. */
struct tl_conjugate_gradient_result tl_conjugate_gradient_solve(const struct tl_linear_system *system,
                                                                struct tl_conjugate_gradient_space *space,
                                                                const vec3d *prescribed, vec3d *step);

/* Row `vertex` of (mu + K) d - b, N: the force that a constraint must add for the vertex to make this step.
 */
vec3d tl_reaction_at(const struct tl_linear_system *system, size_t vertex, const vec3d *step);

#endif
