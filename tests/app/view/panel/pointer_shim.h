/* Pointer and keys of a test's panel, frame by frame. `draw(target)` draws one frame of what is pointed at;
 * it is found beside the target's type. Places in pixels of the window. imgui.h is
 * included before. */
#ifndef TOILE_TESTS_APP_VIEW_PANEL_POINTER_SHIM_H
#define TOILE_TESTS_APP_VIEW_PANEL_POINTER_SHIM_H

template <typename drawn> void click(drawn &target, ImVec2 place)
{
    ImGuiIO &io = ImGui::GetIO();
    io.MousePos = place;
    draw(target);
    io.MouseDown[0] = true;
    draw(target);
    io.MouseDown[0] = false;
    draw(target);
}

template <typename drawn> void press(drawn &target, int key, bool ctrl)
{
    ImGuiIO &io = ImGui::GetIO();
    io.KeyCtrl = ctrl;
    io.KeysDown[key] = true;
    draw(target);
    io.KeysDown[key] = io.KeyCtrl = false;
    draw(target);
}

#endif
