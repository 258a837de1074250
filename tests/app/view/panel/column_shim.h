/* A panel's column without a window: Dear ImGui draws a text of 8 x 8 texels a letter into a target. */
#ifndef TOILE_TESTS_APP_VIEW_PANEL_COLUMN_SHIM_H
#define TOILE_TESTS_APP_VIEW_PANEL_COLUMN_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

#include "render/gpu/gpu.h"

#define COLUMN_SIDE 96 /* pixels of the target, and of the column */

struct column_stage;

struct column_stage *column_begin(tl_gpu *gpu);
void column_end(struct column_stage **stage);

/* Builds the column with this text, draws it into the target, cleared before, and adds up its bytes. */
unsigned column_show(struct column_stage *stage, const char *text);
/* Fills the texture of the glyphs, as another font would change it; with or without telling the column. */
void column_fill_glyphs(struct column_stage *stage, bool forgets);

#ifdef __cplusplus
}
#endif

#endif
