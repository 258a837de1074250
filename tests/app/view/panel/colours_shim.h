/* The row of a colour in the panel, without a window: driven by pointer and keys. */
#ifndef TOILE_TESTS_APP_VIEW_PANEL_COLOURS_SHIM_H
#define TOILE_TESTS_APP_VIEW_PANEL_COLOURS_SHIM_H

#include "app/view/panel/panel_shim.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How the typing ends. */
enum colours_end { COLOURS_ENTER, COLOURS_ESCAPE, COLOURS_CLICK_BESIDE, COLOURS_CLICK_BEFORE };

/* Replaces the text in the row's field, as a hand does, and ends it. `result` gets what the last frames
 * report: whether the option was changed, and the first note. */
void colours_type(const struct tl_binding *binding, const struct tl_option *row, const char *text,
                  enum colours_end end, struct tl_panel_result *result);

/* Whether the row's chip is drawn in an sRGB colour, 0xRRGGBB. */
bool colours_chip_has(const struct tl_binding *binding, const struct tl_option *row, uint32_t rgb);

#ifdef __cplusplus
}
#endif

#endif
