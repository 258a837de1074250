/* A workaround for Dear ImGui's text fields. */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_TEXT_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_TEXT_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

/* To be called after ImGui::NewFrame in every frame. A field that is entered again keeps its undo records
 * although its text has changed since: in 1.86 undoing them writes outside of the text (test panel_text;
 * ocornut/imgui issues 3008 and 4947 report the like). This discards the records as soon as the field is
 * left. */
void tl_panel_forget_text(void);

#ifdef __cplusplus
}
#endif

#endif
