#include "tests/app/view/panel/inputs_shim.h"

#include "app/view/panel/panel_inputs_shim.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <cstdio>
#include <cstring>
#include <vector>

namespace
{

struct field {
    tl_panel_inputs *inputs;
    char text[16], *entered;
};

bool draw(field &field)
{
    ImGui::GetIO().DeltaTime = 0.3f;
    const bool behind = tl_panel_inputs_apply(field.inputs);
    ImGui::NewFrame();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(400, 200));
    ImGui::Begin("window", nullptr, ImGuiWindowFlags_NoTitleBar);
    if (ImGui::InputText("##value", field.text, sizeof field.text, ImGuiInputTextFlags_EnterReturnsTrue))
        snprintf(field.entered, 16, "%s", field.text);
    ImGui::End();
    ImGui::Render();
    return behind;
}

tl_window_event event_of(tl_window_event_type type)
{
    tl_window_event event = {};
    event.type = type;
    event.x = 30;
    event.y = 15;
    return event;
}

void press(std::vector<tl_window_event> &events, int key, int modifiers)
{
    for (const auto type : {TL_WINDOW_KEY, TL_WINDOW_KEY_UP}) {
        events.push_back(event_of(type));
        events.back().key = key;
        events.back().modifiers = modifiers;
        if (type == TL_WINDOW_KEY && key < GLFW_KEY_ESCAPE && !modifiers) {
            events.push_back(event_of(TL_WINDOW_TEXT));
            events.back().key = key >= 'A' ? key - 'A' + 'a' : key;
        }
    }
}

std::vector<tl_window_event> events_of_hand()
{
    std::vector<tl_window_event> events;
    press(events, '3', 0);
    for (const auto type : {TL_WINDOW_MOVE, TL_WINDOW_PRESS, TL_WINDOW_RELEASE})
        events.push_back(event_of(type));
    events.push_back(event_of(TL_WINDOW_KEY));
    events.back().key = GLFW_KEY_LEFT_CONTROL;
    press(events, 'A', GLFW_MOD_CONTROL);
    events.push_back(event_of(TL_WINDOW_KEY_UP));
    events.back().key = GLFW_KEY_LEFT_CONTROL;
    for (const int key :
         {int{'N'}, int{'A'}, int{'V'}, int{'X'}, GLFW_KEY_BACKSPACE, int{'Y'}, GLFW_KEY_ENTER})
        press(events, key, 0);
    return events;
}

} // namespace

void inputs_type(int events_a_frame, char entered[16])
{
    field field = {tl_panel_inputs_create(), "#301020", entered};
    entered[0] = '\0';
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    unsigned char *texels;
    int width, height, count = 0;
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(400, 300);
    io.Fonts->GetTexDataAsRGBA32(&texels, &width, &height);
    io.KeyMap[ImGuiKey_A] = GLFW_KEY_A;
    io.KeyMap[ImGuiKey_Backspace] = GLFW_KEY_BACKSPACE;
    io.KeyMap[ImGuiKey_Enter] = GLFW_KEY_ENTER;
    draw(field);
    draw(field);
    for (const auto &event : events_of_hand()) {
        tl_panel_inputs_take(field.inputs, event);
        if (++count % events_a_frame == 0)
            draw(field);
    }
    while (draw(field))
        ;
    for (int i = 0; i < 3; i++)
        draw(field);
    ImGui::DestroyContext();
    tl_panel_inputs_destroy(&field.inputs);
}
