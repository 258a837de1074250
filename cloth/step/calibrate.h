/* Makes the motion rest where the drape does.
 *
 * A sweep of XPBD leaves each row of constraints less tension than its strain has (cloth/solvers/xpbd.h):
 * cloth that is brought to balance and then played sags by 17 mm at the neck of a dress within a second. So
 * rest strains are calibrated once, with the cloth held where it is: in each round a substep from rest shows
 * what each row exerts, and its rest strain is moved by what is missing. They stay as they are in motion.
 * Rest strains that were learnt in motion do not settle down: friction and contact keep changing what each
 * row has to carry. */
#ifndef TOILE_CLOTH_STEP_CALIBRATE_H
#define TOILE_CLOTH_STEP_CALIBRATE_H

#include "cloth/state.h"

/* Calibrates `preview` for a cloth in balance; positions and velocities are kept. Errors: none. Threads: one
 * at a time per cloth. */
void tl_cloth_calibrate(tl_cloth *cloth, const tl_collider *collider);

#endif
