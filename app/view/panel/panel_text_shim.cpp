#include "app/view/panel/panel_text_shim.h"

#include <imgui.h>
#include <imgui_internal.h>

void tl_panel_forget_text(void)
{
    ImGuiContext &context = *ImGui::GetCurrentContext();
    if (context.ActiveId != context.InputTextState.ID)
        context.InputTextState.ID = 0;
}
