#include "cloth/timestep.h"

#include "cloth/solvers/verlet.h"

int tl_cloth_steps_per_frame(const struct tl_cloth_params *params)
{
    const double rounding = 1e-9;
    return (int)fmax(ceil(1 / (params->frame_rate * params->dt) - rounding), 1);
}

double tl_cloth_step_seconds(const tl_cloth *cloth)
{
    return 1 / (cloth->params.frame_rate * tl_cloth_steps_per_frame(&cloth->params));
}

/* Substeps of `preview` for cloth with mean edges above FINE_EDGE_M, as most garments have. More make coarse
 * triangles as stiff in their plane as the fabric is, so that they lock: at edges of 14 mm a ridge holds the
 * front of a shirt 7 cm off the body with 38 substeps, and not with 30. */
#define COARSE_SUBSTEPS 30
#define FINE_EDGE_M     0.012
/* The longest substep of finer cloth, s per metre of edge. One sweep leaves cloth stretched by a share that
 * grows with the square of the substep over the edge length (xpbd.h), so that with this rule meshes of all
 * edge lengths hang as one of 18 mm does with 30 substeps: a dress on the form with 0.9 % rms strain, and
 * 0.67 if solved to the end. */
#define SUBSTEP_PER_EDGE 0.0317
/* Prestressed cloth hangs where it settled whatever the substep is; but folds are softer in longer ones, and
 * those of a skirt do not come to rest in 4 of its wave steps. With 5 a dress stands still, 0.3 mm low. */
#define PRESTRESSED_SUBSTEPS 20
#define WAVE_STEPS           3.6
/* The mean edge length over struct tl_cloth's shortest_edge. */
#define MEAN_EDGES 100

double tl_cloth_mean_edge(const tl_cloth *cloth)
{
    return MEAN_EDGES * cloth->shortest_edge;
}

static double preview_substeps(const tl_cloth *cloth)
{
    if (cloth->params.substeps > 0)
        return cloth->params.substeps;
    const double step_s = tl_cloth_step_seconds(cloth), edge_m = tl_cloth_mean_edge(cloth);
    if (cloth->energy.is_prestressed)
        return fmin(fmax(ceil(step_s / (WAVE_STEPS * cloth->wave_step_s)), PRESTRESSED_SUBSTEPS),
                    TL_CLOTH_MAX_SUBSTEPS);
    const double wanted = edge_m > FINE_EDGE_M ? 0 : ceil(step_s / (SUBSTEP_PER_EDGE * edge_m));
    return fmin(fmax(wanted, COARSE_SUBSTEPS), TL_CLOTH_MAX_SUBSTEPS);
}

double tl_cloth_substeps_per_step(const tl_cloth *cloth)
{
    if (cloth->params.solver == TL_CLOTH_PREVIEW)
        return preview_substeps(cloth);
    return fmax(ceil(tl_cloth_step_seconds(cloth) / (TL_VERLET_SAFETY * cloth->critical_step)), 1);
}

double tl_cloth_substep(const tl_cloth *cloth)
{
    return tl_cloth_step_seconds(cloth) / tl_cloth_substeps_per_step(cloth);
}
