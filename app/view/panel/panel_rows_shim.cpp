extern "C" {
#include "app/view/panel/panel_rows_shim.h"
#include "config/base/intern.h"
}
#include "app/view/panel/panel_colour_shim.h"
#include "app/view/panel/panel_pictures_shim.h"

#include <imgui.h>

#include <cfloat>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <strings.h>

namespace
{

const ImVec4 changed_colour(0.95f, 0.78f, 0.45f, 1.0f);

char *field_of(const tl_binding &binding, const tl_option &row)
{
    return static_cast<char *>(binding.params) + row.offset;
}

const char *default_of(const tl_binding &binding, const tl_option &row)
{
    return static_cast<const char *>(binding.table->defaults) + row.offset;
}

bool is_text(const tl_option &row)
{
    return row.type == TL_STRING || row.type == TL_PATH;
}

const char *text_of(const tl_binding &binding, const tl_option &row)
{
    return tl_option_text(field_of(binding, row));
}

void set_text(const tl_binding &binding, const tl_option &row, const char *text)
{
    const char *const interned = tl_intern(text);
    memcpy(field_of(binding, row), &interned, sizeof interned);
}

double number_at(const tl_option &row, const char *field)
{
    if (row.type == TL_DOUBLE) {
        double value;
        memcpy(&value, field, sizeof value);
        return value;
    }
    float value;
    memcpy(&value, field, sizeof value);
    return static_cast<double>(value);
}

void set_number(const tl_option &row, char *field, double value)
{
    if (row.type == TL_DOUBLE) {
        memcpy(field, &value, sizeof value);
        return;
    }
    const float narrow = static_cast<float>(value);
    memcpy(field, &narrow, sizeof narrow);
}

/* A slider over several decades is usable only when equal distances are equal ratios. */
bool spans_decades(const tl_option &row, double usual)
{
    const double decades = 1000, headroom = 50;
    if (row.minimum > 0)
        return row.maximum / row.minimum >= decades;
    return row.minimum == 0 && usual > 0 && row.maximum / usual > headroom;
}

double three_digits(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.3g", value);
    return strtod(text, nullptr);
}

bool edit_number(const tl_binding &binding, const tl_option &row)
{
    char format[64];
    snprintf(format, sizeof format, "%%.6g %s", row.unit); /* six digits: a float has no more */
    double value = number_at(row, field_of(binding, row)), before = value;
    const double usual = number_at(row, default_of(binding, row));
    const double wide = 1000; /* wider ranges are too coarse for a linear slider */
    bool edited;
    if (row.minimum < 0 && row.maximum - row.minimum > wide) {
        const float speed = strcmp(row.unit, "degrees") == 0 ? 0.5f : 0.01f; /* per pixel */
        edited = ImGui::DragScalar("##value", ImGuiDataType_Double, &value, speed, &row.minimum, &row.maximum,
                                   format, ImGuiSliderFlags_AlwaysClamp);
    } else {
        int flags = ImGuiSliderFlags_AlwaysClamp;
        if (spans_decades(row, usual))
            flags |= ImGuiSliderFlags_Logarithmic;
        edited = ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &row.minimum, &row.maximum,
                                     format, flags);
    }
    if (!edited || !std::isfinite(value))
        return false;
    if (ImGui::IsMouseDown(0)) /* dragged, not typed */
        value = three_digits(value);
    value = std::fmin(std::fmax(value, row.minimum), row.maximum);
    set_number(row, field_of(binding, row), value);
    return value != before;
}

bool edit_integer(const tl_binding &binding, const tl_option &row)
{
    char format[64];
    snprintf(format, sizeof format, "%%d %s", row.unit);
    int value, usual;
    memcpy(&value, field_of(binding, row), sizeof value);
    memcpy(&usual, default_of(binding, row), sizeof usual);
    int flags = ImGuiSliderFlags_AlwaysClamp;
    if (spans_decades(row, usual))
        flags |= ImGuiSliderFlags_Logarithmic;
    if (!ImGui::SliderInt("##value", &value, static_cast<int>(row.minimum), static_cast<int>(row.maximum),
                          format, flags))
        return false;
    memcpy(field_of(binding, row), &value, sizeof value);
    return true;
}

bool edit_choice(const tl_binding &binding, const tl_option &row)
{
    int value, count = 0;
    memcpy(&value, field_of(binding, row), sizeof value);
    while (row.choices[count])
        count++;
    if (!ImGui::Combo("##value", &value, row.choices, count, count))
        return false;
    memcpy(field_of(binding, row), &value, sizeof value);
    return true;
}

bool edit_switch(const tl_binding &binding, const tl_option &row)
{
    bool value;
    memcpy(&value, field_of(binding, row), sizeof value);
    if (!ImGui::Checkbox("##value", &value))
        return false;
    memcpy(field_of(binding, row), &value, sizeof value);
    return true;
}

bool keep_three(const tl_binding &binding, const tl_option &row, float value[3])
{
    const float lowest = static_cast<float>(row.minimum), highest = static_cast<float>(row.maximum);
    for (int i = 0; i < 3; i++) {
        if (!std::isfinite(value[i]))
            return false;
        value[i] = std::fmin(std::fmax(value[i], lowest), highest);
    }
    memcpy(field_of(binding, row), value, 3 * sizeof *value);
    return true;
}

bool edit_vector(const tl_binding &binding, const tl_option &row)
{
    float value[3];
    memcpy(value, field_of(binding, row), sizeof value);
    return ImGui::DragFloat3("##value", value, 0.01f, static_cast<float>(row.minimum),
                             static_cast<float>(row.maximum), "%.3g", ImGuiSliderFlags_AlwaysClamp) &&
           keep_three(binding, row, value);
}

/* Covers a path that is not being typed by the file's name, of which the field would show the folders. */
void show_file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash || !slash[1] || ImGui::IsItemActive())
        return;
    const ImVec2 lower = ImGui::GetItemRectMin(), upper = ImGui::GetItemRectMax(),
                 padding = ImGui::GetStyle().FramePadding;
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->PushClipRect(lower, upper, true);
    list->AddRectFilled(lower, upper, ImGui::GetColorU32(ImGuiCol_WindowBg));
    list->AddRectFilled(lower, upper, ImGui::GetColorU32(ImGuiCol_FrameBg), ImGui::GetStyle().FrameRounding);
    list->AddText(ImVec2(lower.x + padding.x, lower.y + padding.y), ImGui::GetColorU32(ImGuiCol_Text),
                  slash + 1);
    list->PopClipRect();
}

bool choose(const tl_binding &binding, const tl_option &row, tl_panel_pictures *pictures)
{
    bool edited = false;
    for (int i = 0; row.choices[i]; i++) {
        const bool has_picture = tl_panel_pictures_draw(pictures, row, static_cast<size_t>(i));
        const float height = has_picture ? ImGui::GetItemRectSize().y : 0;
        if (has_picture)
            ImGui::SameLine();
        const bool is_chosen = strcmp(row.choices[i], text_of(binding, row)) == 0;
        if (ImGui::Selectable(row.choices[i], is_chosen, 0, ImVec2(0, height))) {
            set_text(binding, row, row.choices[i]);
            edited = true;
        }
    }
    return edited;
}

bool edit_text(const tl_binding &binding, const tl_option &row, tl_panel_pictures *pictures,
               tl_panel_result &result)
{
    char typed[TL_STRING_SIZE];
    snprintf(typed, sizeof typed, "%s", text_of(binding, row));
    if (row.choices) /* leaves room for the list's arrow */
        ImGui::SetNextItemWidth(-ImGui::GetFrameHeight());
    if (ImGui::InputText("##value", typed, sizeof typed))
        set_text(binding, row, typed);
    bool edited = ImGui::IsItemDeactivatedAfterEdit(); /* a value is taken when typing has ended */
    show_file_name(typed);
    if (!row.choices)
        return edited;
    ImGui::SameLine(0, 0);
    if (!ImGui::BeginCombo("##choices", "",
                           ImGuiComboFlags_NoPreview | ImGuiComboFlags_PopupAlignLeft |
                               ImGuiComboFlags_HeightLarge))
        return edited;
    result.listed = &row;
    ImGui::PushStyleVar(ImGuiStyleVar_SelectableTextAlign, ImVec2(0, 0.5f));
    edited = choose(binding, row, pictures) || edited;
    ImGui::PopStyleVar();
    ImGui::EndCombo();
    return edited;
}

bool edit(const tl_binding &binding, const tl_option &row, tl_panel_pictures *pictures,
          tl_panel_result &result)
{
    switch (row.type) {
    case TL_BOOL:
        return edit_switch(binding, row);
    case TL_INT:
        return edit_integer(binding, row);
    case TL_FLOAT:
    case TL_DOUBLE:
        return edit_number(binding, row);
    case TL_ENUM:
        return edit_choice(binding, row);
    case TL_COLOUR:
        return tl_panel_edit_colour(binding, row, result.note);
    case TL_VECTOR:
        return edit_vector(binding, row);
    case TL_STRING:
    case TL_PATH:
        break;
    }
    return edit_text(binding, row, pictures, result);
}

/* An option's name as a label: spaces for underscores, without the unit, which its widget shows. */
struct label {
    explicit label(const tl_option &row)
    {
        snprintf(text, sizeof text, "%s", row.name);
        char *last = strrchr(text, '_');
        if (last && last[1] && strncasecmp(last + 1, row.unit, strlen(last + 1)) == 0)
            *last = '\0';
        for (char *at = text; *at; at++)
            if (*at == '_')
                *at = ' ';
    }
    char text[64];
};

void explain(const tl_binding &binding, const tl_option &row)
{
    const tl_binding usual = {binding.table, const_cast<void *>(binding.table->defaults)};
    char *text = tl_options_get_text(&usual, &row);
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 25.0f);
    if (is_text(row) && text_of(binding, row)[0])
        ImGui::TextUnformatted(text_of(binding, row)); /* a path is often longer than its widget */
    if (row.type == TL_COLOUR)
        tl_panel_describe_colour(reinterpret_cast<const float *>(field_of(binding, row)));
    ImGui::TextUnformatted(row.help);
    ImGui::TextDisabled("%s.%s", binding.table->name, row.name);
    if (row.type == TL_INT || row.type == TL_FLOAT || row.type == TL_DOUBLE)
        ImGui::TextDisabled("%g to %g %s, by default %s", row.minimum, row.maximum, row.unit, text);
    else
        ImGui::TextDisabled("by default %s", text[0] ? text : "empty");
    if (row.type == TL_COLOUR)
        ImGui::TextDisabled("type #rrggbb, lab(L, a, b), a CSS name, or linear r, g, b");
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
    free(text);
}

} // namespace

bool tl_panel_row_changed(const struct tl_binding *binding, const struct tl_option *row)
{
    return !tl_option_equal(row, field_of(*binding, *row), default_of(*binding, *row));
}

const char *tl_panel_row_text(const struct tl_binding *binding, const struct tl_option *row)
{
    return is_text(*row) ? text_of(*binding, *row) : nullptr;
}

bool tl_panel_rows_begin(const char *id)
{
    if (!ImGui::BeginTable(id, 3, ImGuiTableFlags_None))
        return false;
    ImGui::TableSetupColumn("label", ImGuiTableColumnFlags_WidthStretch, 0.47f);
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 0.53f);
    ImGui::TableSetupColumn("reset", ImGuiTableColumnFlags_WidthFixed, ImGui::GetFrameHeight());
    return true;
}

void tl_panel_rows_end(void)
{
    ImGui::EndTable();
}

bool tl_panel_row(const struct tl_binding *binding, const struct tl_option *row,
                  struct tl_panel_pictures *pictures, struct tl_panel_result *result)
{
    const bool is_changed = tl_panel_row_changed(binding, row);
    const label name(*row);
    ImGui::PushID(binding->table->name);
    ImGui::PushID(row->name);
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    if (is_changed)
        ImGui::TextColored(changed_colour, "%s", name.text);
    else
        ImGui::TextUnformatted(name.text);
    bool explained = ImGui::IsItemHovered();
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-FLT_MIN);
    bool edited = edit(*binding, *row, pictures, *result);
    explained = explained || (ImGui::IsItemHovered() && !ImGui::IsItemActive());
    if (explained)
        explain(*binding, *row);
    ImGui::TableNextColumn();
    if (is_changed && ImGui::ArrowButton("##reset", ImGuiDir_Left)) {
        tl_options_copy(row, binding->table->defaults, binding->params);
        edited = true;
    }
    if (is_changed && ImGui::IsItemHovered())
        ImGui::SetTooltip("back to the default");
    ImGui::PopID();
    ImGui::PopID();
    return edited;
}
