/* The fonts of the panel: glyphs of every text that it shows, from the system's fonts (fontconfig). Dear
 * ImGui 1.86 draws from an atlas of glyphs that is made in advance, so the atlas starts with Latin letters
 * and is rebuilt when a text brings code points that it lacks. A text is drawn code point by code point, left
 * to right: scripts that join or reorder their letters (Arabic, Devanagari) are not shaped.
 *
 * Works on the current ImGui context. Lifetime: from tl_panel_fonts_create until tl_panel_fonts_destroy,
 * within the context's. Threads: the window's. Nothing fails: without fontconfig's fonts ImGui's own bitmap
 * font is used, and missing glyphs are reported once and drawn as "?". */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_FONT_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_FONT_SHIM_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tl_panel_fonts tl_panel_fonts;

/* `pixels`: the size of the letters. `scale`: of the window, for the bitmap font. Builds the first atlas. */
tl_panel_fonts *tl_panel_fonts_create(float pixels, float scale);
void tl_panel_fonts_destroy(tl_panel_fonts **fonts); /* nulls it; null is fine */

/* Notes the code points of a UTF-8 text that is to be drawn; NULL is fine. */
void tl_panel_fonts_note(tl_panel_fonts *fonts, const char *text);
/* Before ImGui::NewFrame: rebuilds the atlas when code points were noted that it lacks. True when it did: the
 * texture must be made again. */
bool tl_panel_fonts_update(tl_panel_fonts *fonts);

#ifdef __cplusplus
}
#endif

#endif
