#include "tests/app/view/panel/colours_shim.h"

extern "C" {
#include "app/view/panel/panel_rows_shim.h"
}
#include "app/view/panel/panel_text_shim.h"

#include <cstdint>
#include <imgui.h>

#include "tests/app/view/panel/pointer_shim.h"

namespace
{

enum { ENTER = 13, ESCAPE = 27, A_KEY = 'A' };

struct scene {
    const tl_binding *binding;
    const tl_option *row;
    tl_panel_result *result;
    char other[16]; /* a field before the row */
    ImVec2 other_corner, corner, end;
};

void draw(scene &scene)
{
    tl_panel_result result = {};
    ImGui::GetIO().DeltaTime = 1 / 60.0f;
    ImGui::NewFrame();
    tl_panel_forget_text();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(400, 200));
    ImGui::Begin("window");
    ImGui::InputText("##other", scene.other, sizeof scene.other);
    scene.other_corner = ImGui::GetItemRectMin();
    if (tl_panel_rows_begin("rows")) {
        scene.corner = ImGui::GetCursorScreenPos();
        result.changed = tl_panel_row(scene.binding, scene.row, nullptr, &result);
        tl_panel_rows_end();
    }
    scene.end = ImGui::GetItemRectMax();
    ImGui::End();
    ImGui::Render();
    scene.result->changed |= result.changed;
    if (scene.result->note.error.code == TL_OK && !scene.result->note.remark[0])
        scene.result->note = result.note;
}

void begin(scene &scene)
{
    unsigned char *texels;
    int width, height;
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(400, 300);
    io.Fonts->GetTexDataAsRGBA32(&texels, &width, &height);
    io.KeyMap[ImGuiKey_Enter] = ENTER;
    io.KeyMap[ImGuiKey_Escape] = ESCAPE;
    io.KeyMap[ImGuiKey_A] = A_KEY;
    draw(scene);
    draw(scene);
}

void end_typing(scene &scene, colours_end end)
{
    switch (end) {
    case COLOURS_ENTER:
        press(scene, ENTER, false);
        break;
    case COLOURS_ESCAPE:
        press(scene, ESCAPE, false);
        break;
    case COLOURS_CLICK_BESIDE:
        click(scene, ImVec2(390, 190));
        break;
    case COLOURS_CLICK_BEFORE:
        click(scene, ImVec2(scene.other_corner.x + 5, scene.other_corner.y + 5));
        break;
    }
}

} // namespace

void colours_type(const tl_binding *binding, const tl_option *row, const char *text, colours_end end,
                  tl_panel_result *result)
{
    scene scene = {binding, row, result, {}, {}, {}, {}};
    *result = {};
    begin(scene);
    click(scene, ImVec2(0.75f * scene.end.x, scene.corner.y + 8)); /* right of the chip */
    press(scene, A_KEY, true);
    ImGui::GetIO().AddInputCharactersUTF8(text);
    draw(scene);
    end_typing(scene, end);
    draw(scene);
    ImGui::DestroyContext();
}

bool colours_chip_has(const tl_binding *binding, const tl_option *row, uint32_t rgb)
{
    tl_panel_result result = {};
    scene scene = {binding, row, &result, {}, {}, {}, {}};
    begin(scene);
    const ImU32 wanted = IM_COL32(rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255, 255);
    bool is_there = false;
    const ImDrawData *data = ImGui::GetDrawData();
    for (int i = 0; i < data->CmdListsCount; i++)
        for (const ImDrawVert &vertex : data->CmdLists[i]->VtxBuffer)
            is_there = is_there || vertex.col == wanted;
    ImGui::DestroyContext();
    return is_there;
}
