/* Input on its way to ImGui 1.86, which samples keys and buttons when a frame begins. What is pressed and
 * released between two frames would be lost, and what is typed would overtake the click before it: after a
 * slow frame a whole word lies between two. So events wait here, and a frame takes as many of them as it can
 * distinguish. For the panel's C++ only.
 *
 * Lifetime: from tl_panel_inputs_create until tl_panel_inputs_destroy. Threads: the window's. Nothing fails.
 */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_INPUTS_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_INPUTS_SHIM_H

extern "C" {
#include "app/view/window/window.h"
}

typedef struct tl_panel_inputs tl_panel_inputs;

tl_panel_inputs *tl_panel_inputs_create(void);
void tl_panel_inputs_destroy(tl_panel_inputs **inputs); /* nulls it; null is fine */

void tl_panel_inputs_take(tl_panel_inputs *inputs, const tl_window_event &event);

/* Passes events on to ImGui's current context; to be called before ImGui::NewFrame. Returns whether some are
 * left for the next frame. */
bool tl_panel_inputs_apply(tl_panel_inputs *inputs);

#endif
