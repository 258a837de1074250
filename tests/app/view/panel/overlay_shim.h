/* The overlay of the window's keys, drawn without a window. */
#ifndef TOILE_TESTS_APP_VIEW_PANEL_OVERLAY_SHIM_H
#define TOILE_TESTS_APP_VIEW_PANEL_OVERLAY_SHIM_H

#include "app/view/panel/panel_shim.h"

#ifdef __cplusplus
extern "C" {
#endif

struct overlay_place {
    float left, top, right, bottom; /* pixels, of its letters and its border */
};

/* Draws the help of `count` rows in a display of `width` x `height` pixels whose right `panel` ones are the
 * panel's, and returns where its letters stand. */
struct overlay_place overlay_draw_help(const struct tl_panel_line *help, size_t count, int width, int height,
                                       int panel);

#ifdef __cplusplus
}
#endif

#endif
