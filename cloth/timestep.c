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

double tl_cloth_substeps_per_step(const tl_cloth *cloth)
{
    if (cloth->params.solver == TL_CLOTH_PREVIEW)
        return cloth->params.substeps;
    if (cloth->params.solver == TL_CLOTH_SETTLE)
        return 1;
    return fmax(ceil(tl_cloth_step_seconds(cloth) / (TL_VERLET_SAFETY * cloth->critical_step)), 1);
}

double tl_cloth_substep(const tl_cloth *cloth)
{
    return tl_cloth_step_seconds(cloth) / tl_cloth_substeps_per_step(cloth);
}
