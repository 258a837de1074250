#include "app/view/panel/panel_inputs_shim.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <bitset>
#include <deque>

struct tl_panel_inputs {
    std::deque<tl_window_event> queued;
    float pointer_x = -1, pointer_y = -1; /* framebuffer pixels */
    bool held[3] = {};                    /* buttons */
};

namespace
{

/* Inputs that a frame has taken so far. */
struct taken {
    bool text = false, buttons = false, pressed = false; /* pressed: a key that writes nothing */
    std::bitset<GLFW_KEY_LAST + 1> keys;                 /* that changed */
};

bool is_key(const tl_window_event &event)
{
    return (event.type == TL_WINDOW_KEY || event.type == TL_WINDOW_KEY_UP) && event.key > 0 &&
           event.key <= GLFW_KEY_LAST;
}

bool is_button(const tl_window_event &event)
{
    return (event.type == TL_WINDOW_PRESS || event.type == TL_WINDOW_RELEASE) && event.button >= 0 &&
           event.button < 3;
}

/* Keys whose characters carry all their information. */
bool only_writes(const tl_window_event &event)
{
    const int commands = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
    return event.key >= GLFW_KEY_SPACE && event.key <= GLFW_KEY_WORLD_2 && !(event.modifiers & commands);
}

/* Whether ImGui, which sees keys, buttons and text of a frame as simultaneous, would take the event as after
 * all that the frame has taken. */
bool fits(const taken &taken, const tl_window_event &event)
{
    if (event.type == TL_WINDOW_TEXT)
        return !taken.buttons && !taken.pressed;
    if (is_key(event) && only_writes(event))
        return !taken.buttons;
    if (is_key(event))
        return !taken.buttons && !taken.text && !taken.keys[static_cast<size_t>(event.key)];
    if (is_button(event))
        return !taken.buttons && !taken.text && taken.keys.none();
    return !taken.buttons; /* the pointer's place is that of the click */
}

void pass_key(const tl_window_event &event, taken &taken)
{
    ImGuiIO &io = ImGui::GetIO();
    io.KeysDown[event.key] = event.type == TL_WINDOW_KEY;
    io.KeyCtrl = io.KeysDown[GLFW_KEY_LEFT_CONTROL] || io.KeysDown[GLFW_KEY_RIGHT_CONTROL];
    io.KeyShift = io.KeysDown[GLFW_KEY_LEFT_SHIFT] || io.KeysDown[GLFW_KEY_RIGHT_SHIFT];
    io.KeyAlt = io.KeysDown[GLFW_KEY_LEFT_ALT] || io.KeysDown[GLFW_KEY_RIGHT_ALT];
    io.KeySuper = io.KeysDown[GLFW_KEY_LEFT_SUPER] || io.KeysDown[GLFW_KEY_RIGHT_SUPER];
    if (only_writes(event))
        return;
    taken.keys[static_cast<size_t>(event.key)] = true;
    taken.pressed |= event.type == TL_WINDOW_KEY;
}

} // namespace

tl_panel_inputs *tl_panel_inputs_create(void)
{
    return new tl_panel_inputs{};
}

void tl_panel_inputs_destroy(tl_panel_inputs **inputs)
{
    delete *inputs;
    *inputs = nullptr;
}

void tl_panel_inputs_take(tl_panel_inputs *inputs, const tl_window_event &event)
{
    const bool moves = event.type == TL_WINDOW_MOVE || event.type == TL_WINDOW_WHEEL;
    if (event.repeated)
        return; /* ImGui repeats what is held by itself */
    if (is_key(event) || is_button(event) || moves || event.type == TL_WINDOW_TEXT)
        inputs->queued.push_back(event);
}

bool tl_panel_inputs_apply(tl_panel_inputs *inputs)
{
    ImGuiIO &io = ImGui::GetIO();
    taken taken;
    auto &queued = inputs->queued;
    for (; !queued.empty() && fits(taken, queued.front()); queued.pop_front()) {
        const tl_window_event &event = queued.front();
        if (event.type == TL_WINDOW_TEXT) {
            io.AddInputCharacter(static_cast<unsigned>(event.key));
            taken.text = true;
            continue;
        }
        if (is_key(event)) {
            pass_key(event, taken);
            continue;
        }
        inputs->pointer_x = event.x;
        inputs->pointer_y = event.y;
        if (event.type == TL_WINDOW_WHEEL)
            io.MouseWheel += event.steps;
        if (is_button(event)) {
            inputs->held[event.button] = event.type == TL_WINDOW_PRESS;
            taken.buttons = true;
        }
    }
    io.MousePos = ImVec2(inputs->pointer_x / io.DisplayFramebufferScale.x,
                         inputs->pointer_y / io.DisplayFramebufferScale.y);
    for (int i = 0; i < 3; i++)
        io.MouseDown[i] = inputs->held[i];
    return !queued.empty();
}
