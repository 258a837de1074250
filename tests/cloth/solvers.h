/* Helpers of tests that run every solver: each solver's step rule, its error at rest and suitable parameters.
 */
#ifndef TOILE_TESTS_CLOTH_SOLVERS_H
#define TOILE_TESTS_CLOTH_SOLVERS_H

#include "cloth/state.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

/* The discrete rule by which a solver advances one linear spring. */
enum step_rule { RULE_IMPLICIT_EULER, RULE_VERLET };

static inline enum step_rule solver_rule(int solver)
{
    return solver == TL_CLOTH_REFERENCE ? RULE_VERLET : RULE_IMPLICIT_EULER;
}

/* Whether the solver's rest state is the minimum of the energy at every step length, or only in the limit h
 * to 0: after one sweep over the constraints each is violated by the later ones, by h^2 w T. */
static inline bool solver_rests_exactly(int solver)
{
    return solver != TL_CLOTH_PREVIEW;
}

/* Parameters of the solver alone. */
static inline struct tl_cloth_params params_exact(int solver)
{
    struct tl_cloth_params params = params_defaults();
    params.solver = solver;
    params.strain_limit = 0; /* the energy alone, without what acts beside it */
    params.self_contact = false;
    return params;
}

/* A step length at which both solvers come to rest soon. */
#define RESTING_STEP (1.0 / 1920)

/* Steps of `h` seconds, of one substep each. */
static inline void params_set_step(struct tl_cloth_params *params, double h)
{
    params->dt = h;
    params->substeps = 1;
}

static inline void cloth_run(tl_cloth *cloth, const tl_collider *collider, double seconds)
{
    tl_error error = {0};
    int frames = (int)ceil(seconds * cloth->params.frame_rate - 1e-9);
    for (int frame = 0; frame < frames; frame++)
        assert_ok(tl_cloth_step(cloth, collider, &error), error);
}

static inline tl_cloth *cloth_make(const tl_garment *garment, const struct tl_cloth_fabric *fabric,
                                   const struct tl_cloth_params *params)
{
    tl_error error = {0};
    tl_cloth *cloth = tl_cloth_create(garment, fabric, params, &error);
    assert_ok(cloth != NULL, error);
    return cloth;
}

/* Linear and angular momentum; all particles are free. */
struct momenta {
    vec3d linear, angular;
    double size; /* sum of m |v| */
};

static inline struct momenta measure_momenta(const struct tl_particles *p)
{
    struct momenta sum = {0};
    for (size_t i = 0; i < p->count; i++) {
        double mass = 1 / p->w[i];
        sum.linear = vec3d_muladd(sum.linear, p->v[i], mass);
        sum.angular = vec3d_muladd(sum.angular, vec3d_cross(p->x[i], p->v[i]), mass);
        sum.size += mass * vec3d_norm(p->v[i]);
    }
    return sum;
}

/* log2 of the ratio of two errors, the step or mesh having been halved between them. */
static inline double observed_order(double coarse, double fine)
{
    return log2(coarse / fine);
}

#endif
