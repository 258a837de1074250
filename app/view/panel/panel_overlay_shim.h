/* The panel's overlay on the view, and its strip of frame times. For the panel's C++ only. */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_OVERLAY_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_OVERLAY_SHIM_H

extern "C" {
#include "app/view/panel/panel_shim.h"
}

/* Places the next ImGui window at shares of the view's width and height; the same shares of the window's own
 * size lie at that point, so that (0.5, 0.5) centres it and (1, 1) puts it into the lower right corner. */
void tl_panel_place_over_view(const tl_panel_input &input, float x, float y);

void tl_panel_overlay_draw(const tl_panel_input &input, tl_panel_result &result);
void tl_panel_strip_draw(const tl_panel_strip &strip);

#endif
