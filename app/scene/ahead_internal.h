/* A step of the cloth beside other work: it runs on a thread of its own, while what the last step left is
 * drawn.
 *
 * The thread has the cloth from tl_ahead_begin to tl_ahead_wait; between them nothing else may touch the
 * cloth or its collider. The step is the one that the caller's own thread would do, to the bit.
 * Threads: begin, wait and take are called on one thread at a time. */
#ifndef TOILE_APP_SCENE_AHEAD_INTERNAL_H
#define TOILE_APP_SCENE_AHEAD_INTERNAL_H

#include "cloth/cloth.h"

struct tl_ahead; /* a step that was begun, and may have ended */

/* Begins a step of `cloth`; both are borrowed until tl_ahead_wait. NULL when there is no thread for it. */
struct tl_ahead *tl_ahead_begin(tl_cloth *cloth, const tl_collider *collider);
/* Waits until the step has ended. NULL is fine. */
void tl_ahead_wait(struct tl_ahead *ahead);
/* Waits, frees and nulls; returns what tl_cloth_step returned. `error` may be NULL, and *ahead must not. */
bool tl_ahead_take(struct tl_ahead **ahead, tl_error *error);

#endif
