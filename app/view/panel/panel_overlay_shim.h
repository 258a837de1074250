/* What the panel draws over the view, and its strip of frame times; parts of the panel
 * (app/view/panel/panel_shim.h) for its C++ alone. */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_OVERLAY_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_OVERLAY_SHIM_H

extern "C" {
#include "app/view/panel/panel_shim.h"
}

/* The next window's place: shares of the view's width and height, which is also the point of the window that
 * lies there. */
void tl_panel_place_over_view(const tl_panel_input &input, float x, float y);

void tl_panel_overlay_draw(const tl_panel_input &input);
void tl_panel_strip_draw(const tl_panel_strip &strip);

#endif
