#include "app/view/panel/panel_colour_shim.h"

extern "C" {
#include "config/colour/lab.h"
#include "config/colour/srgb.h"
}

#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace
{

struct typed_text { /* in the one field that is typed into */
    ImGuiID field;
    char text[128];
};
typed_text typed;

struct channels {
    float of[3];
};

channels linear_at(const tl_binding &binding, const tl_option &row)
{
    channels linear;
    memcpy(linear.of, static_cast<const char *>(binding.params) + row.offset, sizeof linear.of);
    return linear;
}

/* The form of the widgets of ImGui and of the screen. */
channels encoded(channels linear)
{
    for (float &channel : linear.of)
        channel = tl_srgb_from_linear(channel);
    return linear;
}

bool keep(const tl_binding &binding, const tl_option &row, channels linear)
{
    for (float &channel : linear.of)
        channel = std::clamp(channel, static_cast<float>(row.minimum), static_cast<float>(row.maximum));
    memcpy(static_cast<char *>(binding.params) + row.offset, linear.of, sizeof linear.of);
    return true;
}

/* The wheel of the popup "picker". */
bool edit_by_picker(const tl_binding &binding, const tl_option &row)
{
    if (!ImGui::BeginPopup("picker"))
        return false;
    channels picked = encoded(linear_at(binding, row));
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 15);
    bool edited = ImGui::ColorPicker3("##wheel", picked.of,
                                      ImGuiColorEditFlags_PickerHueWheel | ImGuiColorEditFlags_NoInputs |
                                          ImGuiColorEditFlags_NoSidePreview);
    if (edited) {
        for (float &channel : picked.of)
            channel = tl_srgb_to_linear(channel);
        keep(binding, row, picked);
    }
    tl_panel_describe_colour(linear_at(binding, row).of);
    ImGui::EndPopup();
    return edited;
}

bool set_text(const tl_binding &binding, const tl_option &row, const char *text, tl_panel_note &note)
{
    char key[128];
    snprintf(key, sizeof key, "%s.%s", binding.table->name, row.name);
    if (!tl_options_set(&binding, 1, key, text, "view", nullptr, &note.error))
        return false;
    char *remark = tl_option_remark(&row, text);
    snprintf(note.remark, sizeof note.remark, "%s", remark ? remark : "");
    free(remark);
    return true;
}

/* The text counts when typing ends. ImGui's field has it then, unless a click on another widget took the
 * field's place first; so it is kept from frame to frame. Escape brings the first text back, and changes
 * nothing. */
bool edit_by_text(const tl_binding &binding, const tl_option &row, tl_panel_note &note)
{
    const channels linear = linear_at(binding, row);
    const tl_hex hex = tl_hex_of(linear.of);
    char text[sizeof typed.text];
    snprintf(text, sizeof text, "%s", hex.text);
    ImGui::SetNextItemWidth(-FLT_MIN);
    ImGui::InputText("##value", text, sizeof text, ImGuiInputTextFlags_AutoSelectAll);
    const ImGuiID field = ImGui::GetID("##value");
    if (ImGui::IsItemActive()) {
        typed.field = field;
        memcpy(typed.text, text, sizeof text);
        return false;
    }
    if (!ImGui::IsItemDeactivatedAfterEdit() || typed.field != field ||
        ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)))
        return false;
    const char *last = strcmp(text, hex.text) == 0 ? typed.text : text;
    return strcmp(last, hex.text) != 0 && set_text(binding, row, last, note);
}

} // namespace

bool tl_panel_edit_colour(const tl_binding &binding, const tl_option &row, tl_panel_note &note)
{
    const channels shown = encoded(linear_at(binding, row));
    const float side = ImGui::GetFrameHeight();
    if (ImGui::ColorButton("##chip", ImVec4(shown.of[0], shown.of[1], shown.of[2], 1),
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop,
                           ImVec2(1.5f * side, side)))
        ImGui::OpenPopup("picker");
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("choose another colour");
    bool edited = edit_by_picker(binding, row);
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    return edit_by_text(binding, row, note) || edited;
}

void tl_panel_describe_colour(const float linear[3])
{
    const tl_lab lab = tl_lab_of(linear);
    ImGui::Text("%s   Lab %.1f %.1f %.1f (D65)", tl_hex_of(linear).text, lab.l, lab.a, lab.b);
}
