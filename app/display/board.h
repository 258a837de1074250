/* The pattern board: a garment's pieces, flat, on a wall beside it (scene.pattern). The triangles are the
 * garment's own, so that what is known of one of them, such as its strain, shows in both places. Metres,
 * world axes. */
#ifndef TOILE_APP_DISPLAY_BOARD_H
#define TOILE_APP_DISPLAY_BOARD_H

#include "app/display/moving.h"

#define TL_SURFACE_PATTERN "pattern"

/* Places the pieces to the right of what is inside `beside`, upright and facing +Z, on or above y = 0; `out`
 * is empty when the garment has no pattern. Borrows the garment, which must outlive *out. */
void tl_board_make(const tl_garment *garment, struct tl_box beside, struct tl_moving *out);

/* The board's surface, of the garment's own: appearance, strains and borders are shared. */
tl_surface tl_board_surface(const struct tl_moving *board, const tl_surface *garment);

#endif
