/* Widgets for the rows of an option table; part of the panel (app/view/panel/panel_shim.h), between its
 * NewFrame and Render. */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_ROWS_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_ROWS_SHIM_H

#include "app/view/panel/panel_shim.h"

struct tl_panel_pictures;

/* Label, widget and reset button of one option, as a row of the current three-column table. True when the
 * value was changed; it stays within the row's range. `result` gets what
 * is to be reported, and the option whose list is open. */
bool tl_panel_row(const struct tl_binding *binding, const struct tl_option *row,
                  struct tl_panel_pictures *pictures, struct tl_panel_result *result);

/* True when the option differs from its table's default. */
bool tl_panel_row_changed(const struct tl_binding *binding, const struct tl_option *row);

/* The value of a text option; NULL for the other types. Borrowed from the params. */
const char *tl_panel_row_text(const struct tl_binding *binding, const struct tl_option *row);

/* Opens and closes such a table. */
bool tl_panel_rows_begin(const char *id);
void tl_panel_rows_end(void);

#endif
