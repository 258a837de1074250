/* The widget of a colour: a chip, which opens a picker, and a field that shows the colour by hex and takes it
 * in every form that its option does. For the panel's C++ only, between its NewFrame and Render. */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_COLOUR_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_COLOUR_SHIM_H

extern "C" {
#include "app/view/panel/panel_shim.h"
}

/* Edits the colour of a TL_COLOUR row. True when it was changed. A text that the option refuses, or takes as
 * another colour, is reported in `note`. */
bool tl_panel_edit_colour(const tl_binding &binding, const tl_option &row, tl_panel_note &note);

/* Lines of text: the colour in each of its forms. */
void tl_panel_describe_colour(const float linear[3]);

#endif
