/* The textures of the pictures in the panel's open list. For the panel's C++ only.
 *
 * Lifetime: from tl_panel_pictures_create until tl_panel_pictures_destroy, within the GL context's. Threads:
 * the window's. Nothing fails. */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_PICTURES_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_PICTURES_SHIM_H

extern "C" {
#include "app/view/panel/panel_shim.h"
}

typedef struct tl_panel_pictures tl_panel_pictures;

tl_panel_pictures *tl_panel_pictures_create(tl_gpu *gpu);
void tl_panel_pictures_destroy(tl_panel_pictures **pictures); /* nulls it; null is fine */

/* The list of this frame; its textures are made when an image is shown for the first time, and kept. */
void tl_panel_pictures_follow(tl_panel_pictures *pictures, const tl_panel_list &list);

/* Draws the picture of choice `index`, or the room that it will take; the label's height is the picture's.
 * False for a row without pictures. */
bool tl_panel_pictures_draw(tl_panel_pictures *pictures, const tl_option &row, size_t index);

#endif
