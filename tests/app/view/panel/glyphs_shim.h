/* Looks into the atlas of Dear ImGui's current context, without a window. */
#ifndef TOILE_TESTS_APP_VIEW_PANEL_GLYPHS_SHIM_H
#define TOILE_TESTS_APP_VIEW_PANEL_GLYPHS_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

void glyphs_begin(void); /* a context */
void glyphs_end(void);
int glyphs_missing(const char *text); /* code points of a UTF-8 text that the first font has no glyph for */
int glyphs_atlas_texels(void);

#ifdef __cplusplus
}
#endif

#endif
