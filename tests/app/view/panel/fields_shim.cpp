#include "tests/app/view/panel/fields_shim.h"

#include "app/view/panel/panel_text_shim.h"

#include <cstdint>
#include <cstring>
#include <imgui.h>

#include "tests/app/view/panel/pointer_shim.h"

namespace
{

enum { UNDO = 'Z', REDO = 'Y', BACKSPACE = 8 };

/* A fixed sequence [Knuth's MMIX]; any would do. */
unsigned any_below(unsigned end)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<unsigned>(state >> 33) % end;
}

struct field {
    char text[1024];
    ImVec2 corner;
};

void draw(field &field)
{
    ImGui::GetIO().DeltaTime = 1 / 60.0f;
    ImGui::NewFrame();
    tl_panel_forget_text();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(400, 200));
    ImGui::Begin("window");
    ImGui::InputText("##value", field.text, sizeof field.text);
    field.corner = ImGui::GetItemRectMin();
    ImGui::End();
    ImGui::Render();
}

void edit(field &field)
{
    switch (any_below(6)) {
    case 0:
        press(field, BACKSPACE, false);
        break;
    case 1:
        press(field, UNDO, true);
        break;
    case 2:
        press(field, REDO, true);
        break;
    default:
        ImGui::GetIO().AddInputCharacter('a' + any_below(26));
        draw(field);
    }
}

} // namespace

void fields_drive(int rounds)
{
    field field = {};
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    unsigned char *texels;
    int width, height;
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(400, 300);
    io.Fonts->GetTexDataAsRGBA32(&texels, &width, &height);
    io.KeyMap[ImGuiKey_Z] = UNDO;
    io.KeyMap[ImGuiKey_Y] = REDO;
    io.KeyMap[ImGuiKey_Backspace] = BACKSPACE;
    draw(field);
    draw(field);
    for (int round = 0; round < rounds; round++) {
        click(field, ImVec2(field.corner.x + 20, field.corner.y + 5));
        for (int i = 0; i < 30; i++)
            edit(field);
        click(field, ImVec2(300, 150));
        const unsigned length = any_below(3) > 0 ? any_below(sizeof field.text - 1) : 0;
        memset(field.text, 'q', length);
        field.text[length] = '\0';
    }
    ImGui::DestroyContext();
}
