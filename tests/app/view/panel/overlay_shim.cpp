#include "tests/app/view/panel/overlay_shim.h"

#include "app/view/panel/panel_overlay_shim.h"

#include <algorithm>
#include <imgui.h>

namespace
{

/* The box of every vertex that ImGui would draw, before clipping: letters that are cut off count. */
overlay_place place_of(const ImDrawData &data)
{
    overlay_place place = {1e9f, 1e9f, -1e9f, -1e9f};
    for (int i = 0; i < data.CmdListsCount; i++)
        for (const ImDrawVert &vertex : data.CmdLists[i]->VtxBuffer) {
            place.left = std::min(place.left, vertex.pos.x);
            place.right = std::max(place.right, vertex.pos.x);
            place.top = std::min(place.top, vertex.pos.y);
            place.bottom = std::max(place.bottom, vertex.pos.y);
        }
    return place;
}

} // namespace

overlay_place overlay_draw_help(const tl_panel_line *help, size_t count, int width, int height, int panel)
{
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    unsigned char *texels;
    int atlas_width, atlas_height;
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
    io.Fonts->GetTexDataAsRGBA32(&texels, &atlas_width, &atlas_height);
    tl_panel_input input = {};
    tl_panel_result result = {};
    input.message = "";
    input.help = help;
    input.help_count = count;
    input.x = width - panel;
    input.width = panel;
    input.height = height;
    overlay_place place = {};
    for (int frame = 0; frame < 4; frame++) { /* ImGui knows a window's size from its second frame on */
        io.DeltaTime = 1 / 60.0f;
        ImGui::NewFrame();
        tl_panel_overlay_draw(input, result);
        ImGui::Render();
        place = place_of(*ImGui::GetDrawData());
    }
    ImGui::DestroyContext();
    return place;
}
