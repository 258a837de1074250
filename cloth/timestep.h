/* Time: a frame is made of equal steps, a step of equal substeps. Threads: pure. */
#ifndef TOILE_CLOTH_TIMESTEP_H
#define TOILE_CLOTH_TIMESTEP_H

#include "cloth/state.h"

/* The fewest equal steps that fill a frame, none longer than params->dt. */
int tl_cloth_steps_per_frame(const struct tl_cloth_params *params);

/* Duration of one step, seconds. */
double tl_cloth_step_seconds(const tl_cloth *cloth);

/* Substeps of the chosen solver in one step; HUGE_VAL when no substep is short enough. */
double tl_cloth_substeps_per_step(const tl_cloth *cloth);

/* Duration of one substep of the chosen solver, seconds: a frame is a whole number of equal ones. */
double tl_cloth_substep(const tl_cloth *cloth);

/* The mean edge length, about the root of the mean area per vertex, m. */
double tl_cloth_mean_edge(const tl_cloth *cloth);

#endif
