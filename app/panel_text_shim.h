/* What Dear ImGui's text fields need beside it. */
#ifndef TOILE_APP_PANEL_TEXT_SHIM_H
#define TOILE_APP_PANEL_TEXT_SHIM_H

#ifdef __cplusplus
extern "C" {
#endif

/* After ImGui::NewFrame, every frame. A field that is entered again goes on with its old steps of undo,
 * though its text has changed since: up to 1.87 undoing them writes outside of the text (ocornut/imgui issue
 * 4947). This forgets them as soon as the field is left. */
void tl_panel_forget_text(void);

#ifdef __cplusplus
}
#endif

#endif
