/* What Dear ImGui's text fields need beside it. */
#ifndef TOILE_APP_VIEW_PANEL_PANEL_TEXT_SHIM_H
#define TOILE_APP_VIEW_PANEL_PANEL_TEXT_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

/* After ImGui::NewFrame, every frame. A field that is entered again goes on with its old steps of undo,
 * though its text has changed since: in 1.86 undoing them writes outside of the text (test panel_text;
 * reports of its kind are ocornut/imgui issues 3008 and 4947). This forgets them as soon as the field is
 * left. */
void tl_panel_forget_text(void);

#ifdef __cplusplus
}
#endif

#endif
