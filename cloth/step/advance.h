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

/* Whether tl_cloth_step moves the cloth by a cage, unless none can be made (caged.c). */
bool tl_cloth_is_caged(const tl_cloth *cloth);

/* Advances under drag until no vertex moves, or for three seconds; velocities are 0 then. Errors: as
 * tl_cloth_advance. */
bool tl_cloth_come_to_rest(tl_cloth *cloth, const tl_collider *collider, tl_error *error);

/* Fails with TL_UNSTABLE where the state is not finite or is strained by more than TL_CLOTH_MAX_STRAIN. */
bool tl_cloth_check_state(const tl_cloth *cloth, tl_error *error);

#endif
