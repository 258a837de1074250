/* Bringing a cloth to balance: dynamic relaxation (cloth/solvers/relaxation.h) on the cloth's whole energy,
 * against the avatar, the ground and itself, with friction.
 *
 * Why not the motion with drag until nothing moves: one sweep of XPBD a substep leaves cloth stretched, and
 * friction keeps it where that has brought it, even if it is solved exactly from there on. The default dress
 * hung 16 mm wide at the neck and 12 mm low at its hem. Relaxation does not stretch what it has not to. */
#ifndef TOILE_CLOTH_STEP_RELAX_H
#define TOILE_CLOTH_STEP_RELAX_H

#include "cloth/state.h"

/* Moves the cloth until its residual is in balance, no longer becomes less, or params.settle_s are over, of
 * which each step counts as one substep. `carried`: it comes from a coarser cloth that is in balance. Writes
 * the residual. Reports progress; stops early when tl_interrupted() is true. Velocities are 0 afterwards.
 *
 * Errors: TL_UNSTABLE, and the positions are those of the start; TL_INTERRUPTED, and they are those so far.
 * Lifetime: `collider` may be NULL; it is borrowed until the next call that takes a collider. Threads: one at
 * a time per cloth; results do not depend on the number of threads. */
bool tl_cloth_relax(tl_cloth *cloth, const tl_collider *collider, bool carried, struct tl_residual *residual,
                    tl_error *error);

#endif
