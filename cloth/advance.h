/* One frame of simulated time, for tl_cloth_step and tl_cloth_settle. Threads: one at a time per cloth. */
#ifndef TOILE_CLOTH_ADVANCE_H
#define TOILE_CLOTH_ADVANCE_H

#include "cloth/state.h"

/* How one frame is advanced. */
struct tl_advance_params {
    double drag;           /* 1/s, in place of the fabric's damping when larger */
    bool clock;            /* the animation's time passes */
    double contact_budget; /* settle: what further rounds of contact may take, as a share of the first */
    double min_slip_speed; /* m/s: see struct tl_contact_params */
};

/* m/s. Worn cloth is held by hundreds of particles near their limit of friction, which take turns to stick
 * and slip: at a tenth of this they never all stick, and a dress creeps for ever at some mm/s. */
#define TL_MIN_SLIP_SPEED 1e-3

/* One frame; restores the state and fails when the result is out of its envelope. */
bool tl_cloth_advance(tl_cloth *cloth, const tl_collider *collider, const struct tl_advance_params *advance,
                      tl_error *error);

/* The open seams as springs for `settle`. */
struct tl_springs tl_cloth_springs(const tl_cloth *cloth);

#endif
