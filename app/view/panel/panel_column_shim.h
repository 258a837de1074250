/* The panel's column, kept as a texture: it is drawn again only when what ImGui would draw there differs from
 * what it drew last. For the panel's C++ only.
 *
 * Lifetime: from tl_panel_column_create until tl_panel_column_destroy, within the GL context's and ImGui's.
 * Threads: the window's. Nothing fails. */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_COLUMN_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_COLUMN_SHIM_H

extern "C" {
#include "render/gpu/gpu.h"
}

struct ImDrawData;
struct ImDrawList;

typedef struct tl_panel_column tl_panel_column;

tl_panel_column *tl_panel_column_create(tl_gpu *gpu);
void tl_panel_column_destroy(tl_panel_column **column); /* nulls it; null is fine */

/* The glyphs have another texture: what is kept may not be shown again. */
void tl_panel_column_forget(tl_panel_column *column);

struct tl_panel_column_place {
    const ImDrawList *list;    /* of the panel's window, which is opaque; NULL: it is hidden */
    float x, y, width, height; /* in ImGui's pixels */
};

/* Draws `data` into the current framebuffer: the panel's window from the texture, all else over it. */
void tl_panel_column_draw(tl_panel_column *column, const ImDrawData &data,
                          const tl_panel_column_place &place);

#endif
