/* One frame of simulated time, for tl_cloth_step (caged.c) and tl_cloth_settle. Threads: one at a time per
 * cloth. */
#ifndef TOILE_CLOTH_STEP_ADVANCE_H
#define TOILE_CLOTH_STEP_ADVANCE_H

#include "cloth/state.h"

/* The way in which tl_cloth_advance advances one frame. */
struct tl_advance_params {
    double drag; /* 1/s, replaces the fabric's damping if larger */
    bool clock;  /* whether the animation's clock runs */
};

/* Advances by one frame. Errors: as tl_cloth_settle; positions and velocities are then those of the frame's
 * start. */
bool tl_cloth_advance(tl_cloth *cloth, const tl_collider *collider, const struct tl_advance_params *advance,
                      tl_error *error);

/* One substep of `preview` against a collider that stands where its motion ends; `applied` receives what the
 * rows exert (cloth/solvers/xpbd.h). */
void tl_cloth_preview_substep(tl_cloth *cloth, const tl_collider *collider, double (*applied)[3][TL_BATCH]);

/* Fails with TL_UNSTABLE where the state is not finite or is strained by more than TL_CLOTH_MAX_STRAIN. */
bool tl_cloth_check_state(const tl_cloth *cloth, tl_error *error);

#endif
