/* Holds: vertices that are drawn to a plane while a garment is put on (struct tl_hold), like a waist that one
 * keeps up by hand until it sits. Metres, seconds. Threads: pure. */
#ifndef TOILE_CLOTH_DRIVE_HOLDS_H
#define TOILE_CLOTH_DRIVE_HOLDS_H

#include "assets/base/garment.h"
#include "cloth/mesh/particles.h"

/* Brings each held particle nearer to its plane than it was at the substep's start, by TL_HOLD_SPEED h, and
 * holds one that is there: while the garment hangs, those of height; before, while it is sewn, the others.
 * weld [render vertex]. */
#define TL_HOLD_SPEED 0.5 /* m/s */
void tl_holds_draw(const struct tl_hold *holds, size_t count, const uint32_t *weld, bool hanging, double h,
                   struct tl_particles *particles);

#endif
