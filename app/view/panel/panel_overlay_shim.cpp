#include "app/view/panel/panel_overlay_shim.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <vector>

namespace
{

const int overlay_flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav |
                          ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_AlwaysAutoResize |
                          ImGuiWindowFlags_NoSavedSettings;
const ImU32 light = IM_COL32(235, 235, 235, 255), dim = IM_COL32(130, 130, 130, 255),
            amber = IM_COL32(240, 180, 80, 255), shade = IM_COL32(0, 0, 0, 150);
const float margin = 10; /* between overlays and the view's edges */

float view_width(const tl_panel_input &input)
{
    const ImGuiIO &io = ImGui::GetIO();
    return io.DisplaySize.x - static_cast<float>(input.width) / io.DisplayFramebufferScale.x;
}

/* Reserves the size of a new text: ImGui learns the size of a window's content one frame late, and would cut
 * the text off in its first frame. */
void make_room(const char *text, float wrap = -1)
{
    ImGui::SetNextWindowContentSize(ImGui::CalcTextSize(text, nullptr, false, wrap));
}

bool begin_overlay(const char *name, const tl_panel_input &input, float x, float y)
{
    tl_panel_place_over_view(input, x, y);
    ImGui::SetNextWindowBgAlpha(0.75f);
    return ImGui::Begin(name, nullptr, overlay_flags);
}

void draw_message(const tl_panel_input &input)
{
    if (!input.message[0])
        return;
    const ImVec4 red(1.0f, 0.55f, 0.50f, 1.0f), plain(0.92f, 0.92f, 0.92f, 1.0f);
    const float wrap = 0.8f * view_width(input);
    make_room(input.message, wrap);
    begin_overlay("message", input, 0, 1);
    ImGui::PushStyleColor(ImGuiCol_Text, input.message_is_error ? red : plain);
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + wrap);
    ImGui::TextUnformatted(input.message);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::End();
}

void draw_status(const tl_panel_input &input)
{
    if (!input.status || !input.status[0])
        return;
    make_room(input.status);
    begin_overlay("status", input, 0, 0);
    ImGui::TextUnformatted(input.status);
    ImGui::End();
}

/* Rows of buttons, each behind its heading; what holds at present is lighter. */
void draw_choices(const tl_panel_input &input, tl_panel_result &result)
{
    const ImU32 chosen = IM_COL32(150, 115, 45, 255);
    float indent = 0;
    for (size_t i = 0; i < input.choice_count; i++)
        indent = std::max(indent, ImGui::CalcTextSize(input.choices[i].row).x);
    indent += 2 * ImGui::GetStyle().ItemSpacing.x;
    for (size_t i = 0; i < input.choice_count; i++) {
        const tl_panel_choice &choice = input.choices[i];
        if (i == 0 || strcmp(input.choices[i - 1].row, choice.row) != 0) {
            ImGui::AlignTextToFramePadding();
            ImGui::TextUnformatted(choice.row);
            ImGui::SameLine(indent);
        } else {
            ImGui::SameLine();
        }
        if (choice.is_chosen)
            ImGui::PushStyleColor(ImGuiCol_Button, chosen);
        if (ImGui::Button(choice.label))
            result.choice = static_cast<int>(i);
        if (choice.is_chosen)
            ImGui::PopStyleColor();
        if (choice.help && ImGui::IsItemHovered())
            ImGui::SetTooltip("%s", choice.help);
    }
}

/* Below the status; the image stays in use beside it. */
void draw_notice(const tl_panel_input &input, tl_panel_result &result)
{
    if (!input.notice || !input.notice[0])
        return;
    const ImVec4 warm(0.98f, 0.80f, 0.45f, 1.0f);
    const float wrap = 0.8f * view_width(input), line = 2.4f * ImGui::GetFontSize();
    tl_panel_place_over_view(input, 0, line / ImGui::GetIO().DisplaySize.y);
    ImGui::SetNextWindowBgAlpha(0.85f);
    if (input.choice_count == 0)
        make_room(input.notice, wrap);
    ImGui::Begin("notice", nullptr,
                 input.choice_count > 0 ? overlay_flags & ~ImGuiWindowFlags_NoMouseInputs : overlay_flags);
    ImGui::PushStyleColor(ImGuiCol_Text, warm);
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + wrap);
    ImGui::TextUnformatted(input.notice);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    draw_choices(input, result);
    ImGui::End();
}

void draw_progress(const tl_panel_input &input)
{
    if (!input.progress.what)
        return;
    begin_overlay("progress", input, 0.5f, 0.5f);
    ImGui::TextUnformatted(input.progress.what);
    const float width = 22 * ImGui::GetFontSize();
    if (input.progress.share >= 0)
        ImGui::ProgressBar(input.progress.share, ImVec2(width, 0));
    ImGui::TextDisabled("%s", input.progress.hint);
    ImGui::End();
}

void draw_label(const char *text, float x, float y, float aligned)
{
    const float border = 5;
    const ImVec2 size = ImGui::CalcTextSize(text);
    const ImVec2 corner(x - aligned * size.x, y);
    ImDrawList *list = ImGui::GetBackgroundDrawList();
    list->AddRectFilled(ImVec2(corner.x - border, corner.y - border),
                        ImVec2(corner.x + size.x + border, corner.y + size.y + border), shade, 3);
    list->AddText(corner, light, text);
}

void draw_wipe(const tl_panel_input &input)
{
    const ImGuiIO &io = ImGui::GetIO();
    if (input.wipe.column <= 0)
        return;
    const float x = static_cast<float>(input.wipe.column) / io.DisplayFramebufferScale.x;
    const float height = io.DisplaySize.y, middle = 0.5f * height, handle = 7, gap = 14;
    ImDrawList *list = ImGui::GetBackgroundDrawList();
    list->PushClipRect(ImVec2(0, 0), ImVec2(view_width(input), height));
    list->AddLine(ImVec2(x, 0), ImVec2(x, height), shade, 3);
    list->AddLine(ImVec2(x, 0), ImVec2(x, height), light, 1);
    list->AddCircleFilled(ImVec2(x, middle), handle, light);
    draw_label(input.wipe.left, x - gap, gap, 1);
    draw_label(input.wipe.right, x + gap, gap, 0);
    list->PopClipRect();
}

ImU32 colour_of(const float srgb[3])
{
    return ImGui::ColorConvertFloat4ToU32(ImVec4(srgb[0], srgb[1], srgb[2], 1));
}

/* Colours are interpolated between stops, which need not be equidistant. */
void draw_scale(const tl_panel_legend &legend)
{
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = 18 * ImGui::GetFontSize(), height = ImGui::GetFontSize();
    const float span = legend.high - legend.low;
    ImDrawList *list = ImGui::GetWindowDrawList();
    for (int i = 0; i + 1 < legend.stop_count && span > 0; i++) {
        const float from = corner.x + width * (legend.stop_values[i] - legend.low) / span;
        const float to = corner.x + width * (legend.stop_values[i + 1] - legend.low) / span;
        const ImU32 left = colour_of(legend.stop_colours[i]), right = colour_of(legend.stop_colours[i + 1]);
        list->AddRectFilledMultiColor(ImVec2(from, corner.y), ImVec2(to, corner.y + height), left, right,
                                      right, left);
    }
    ImGui::Dummy(ImVec2(width, height));
    for (int i = 0; i <= 4; i++) {
        char text[32];
        const float value = legend.low + 0.25f * static_cast<float>(i) * span;
        snprintf(text, sizeof text, "%.3g%s%s", static_cast<double>(value), legend.unit[0] ? " " : "",
                 legend.unit);
        const float share = 0.25f * static_cast<float>(i), room = ImGui::CalcTextSize(text).x;
        if (i > 0)
            ImGui::SameLine();
        ImGui::SetCursorScreenPos(ImVec2(corner.x + share * (width - room), ImGui::GetCursorScreenPos().y));
        ImGui::TextUnformatted(text);
    }
}

void draw_legend(const tl_panel_input &input)
{
    if (!input.legend)
        return;
    const tl_panel_legend &legend = *input.legend;
    begin_overlay("legend", input, 1, 1);
    ImGui::TextUnformatted(legend.title);
    if (legend.stop_count > 1)
        draw_scale(legend);
    for (int i = 0; i < legend.entry_count; i++) {
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const float side = ImGui::GetFontSize();
        ImGui::GetWindowDrawList()->AddRectFilled(corner, ImVec2(corner.x + side, corner.y + side),
                                                  colour_of(legend.entry_colours[i]));
        ImGui::Dummy(ImVec2(side, side));
        ImGui::SameLine();
        ImGui::TextUnformatted(legend.entry_labels[i]);
    }
    if (legend.note[0]) {
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + 18 * ImGui::GetFontSize());
        ImGui::TextDisabled("%s", legend.note);
        ImGui::PopTextWrapPos();
    }
    ImGui::End();
}

void draw_marks(const tl_panel_input &input)
{
    const ImGuiIO &io = ImGui::GetIO();
    const float radius = 7;
    ImDrawList *list = ImGui::GetBackgroundDrawList();
    list->PushClipRect(ImVec2(0, 0), ImVec2(view_width(input), io.DisplaySize.y));
    for (size_t i = 0; i < input.mark_count; i++) {
        const ImVec2 at(input.marks[i][0] / io.DisplayFramebufferScale.x,
                        input.marks[i][1] / io.DisplayFramebufferScale.y);
        list->AddCircle(at, radius, shade, 0, 4);
        list->AddCircle(at, radius, amber, 0, 2);
    }
    list->PopClipRect();
}

/* Each over a dark copy of itself that is a little larger, so that it is seen on any cloth. */
void draw_shape(ImDrawList &list, const tl_panel_shape &shape, const ImVec2 *points)
{
    const int count = static_cast<int>(shape.count);
    const float border = 1.5f;
    const ImU32 colour = ImGui::ColorConvertFloat4ToU32(
        ImVec4(shape.colour[0], shape.colour[1], shape.colour[2], shape.colour[3]));
    if (shape.text) {
        const ImVec2 size = ImGui::CalcTextSize(shape.text);
        const ImVec2 corner(points[0].x - 0.5f * size.x, points[0].y - 0.5f * size.y);
        list.AddText(ImVec2(corner.x + 1, corner.y + 1), shade, shape.text);
        list.AddText(corner, colour, shape.text);
    } else if (shape.width > 0) {
        list.AddPolyline(points, count, shade, 0, shape.width + 2 * border);
        list.AddPolyline(points, count, colour, 0, shape.width);
    } else {
        list.AddConvexPolyFilled(points, count, colour);
        list.AddPolyline(points, count, shade, ImDrawFlags_Closed, border);
    }
}

void draw_shapes(const tl_panel_input &input)
{
    const ImGuiIO &io = ImGui::GetIO();
    ImDrawList *list = ImGui::GetBackgroundDrawList();
    list->PushClipRect(ImVec2(0, 0), ImVec2(view_width(input), io.DisplaySize.y));
    for (size_t i = 0; i < input.shape_count; i++) {
        tl_panel_shape shape = input.shapes[i];
        std::vector<ImVec2> points;
        for (size_t k = 0; k < shape.count; k++)
            points.emplace_back(shape.points[k][0] / io.DisplayFramebufferScale.x,
                                shape.points[k][1] / io.DisplayFramebufferScale.y);
        shape.width /= io.DisplayFramebufferScale.x;
        draw_shape(*list, shape, points.data());
    }
    list->PopClipRect();
}

/* Next to the pointer, towards the middle of the view. */
void draw_read_out(const tl_panel_input &input)
{
    if (!input.read_out || !input.read_out[0])
        return;
    const ImGuiIO &io = ImGui::GetIO();
    const bool is_right = io.MousePos.x > 0.5f * view_width(input);
    const bool is_low = io.MousePos.y > 0.5f * io.DisplaySize.y;
    const float offset = 16;
    ImGui::SetNextWindowPos(ImVec2(io.MousePos.x + (is_right ? -offset : offset), io.MousePos.y),
                            ImGuiCond_Always, ImVec2(is_right ? 1.0f : 0.0f, is_low ? 1.0f : 0.0f));
    ImGui::SetNextWindowBgAlpha(0.85f);
    make_room(input.read_out);
    ImGui::Begin("read out", nullptr, overlay_flags);
    ImGui::TextUnformatted(input.read_out);
    ImGui::End();
}

/* Below the pointer, where it covers no handle; above it at the view's lower edge. */
void draw_amount(const tl_panel_input &input)
{
    if (!input.amount || !input.amount[0])
        return;
    const ImGuiIO &io = ImGui::GetIO();
    const float offset = 28;
    const bool is_low = io.MousePos.y + 3 * offset > io.DisplaySize.y;
    ImGui::SetNextWindowPos(ImVec2(io.MousePos.x, io.MousePos.y + (is_low ? -offset : offset)),
                            ImGuiCond_Always, ImVec2(0.5f, is_low ? 1.0f : 0.0f));
    ImGui::SetNextWindowBgAlpha(0.85f);
    make_room(input.amount);
    ImGui::Begin("amount", nullptr, overlay_flags);
    ImGui::TextUnformatted(input.amount);
    ImGui::End();
}

/* The heading nearest after the middle: rows are drawn in two columns that break there. */
size_t middle_of(const tl_panel_line *help, size_t count)
{
    size_t middle = (count + 1) / 2;
    while (middle < count && help[middle].cells[1][0])
        middle++;
    return middle;
}

void draw_help_rows(const char *name, const tl_panel_line *help, size_t count)
{
    if (!ImGui::BeginTable(name, 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoHostExtendX))
        return;
    for (size_t i = 0; i < count; i++) {
        const bool is_heading = !help[i].cells[1][0];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        if (is_heading && i > 0)
            ImGui::Spacing();
        if (is_heading)
            ImGui::TextDisabled("%s", help[i].cells[0]);
        else
            ImGui::TextUnformatted(help[i].cells[0]);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(help[i].cells[1]);
    }
    ImGui::EndTable();
}

ImVec2 size_of_rows(const tl_panel_line *help, size_t count)
{
    const ImGuiStyle &style = ImGui::GetStyle();
    float left = 0, right = 0, height = 0;
    for (size_t i = 0; i < count; i++) {
        left = std::max(left, ImGui::CalcTextSize(help[i].cells[0]).x);
        right = std::max(right, ImGui::CalcTextSize(help[i].cells[1]).x);
        height += ImGui::GetTextLineHeight() + 2 * style.CellPadding.y;
        if (!help[i].cells[1][0] && i > 0)
            height += style.ItemSpacing.y;
    }
    return ImVec2(left + right + 4 * style.CellPadding.x, height);
}

/* The share of its size at which the help fits between the view's edges. */
float scale_of_help(const tl_panel_input &input, size_t middle, float gap)
{
    const ImVec2 left = size_of_rows(input.help, middle),
                 right = size_of_rows(input.help + middle, input.help_count - middle),
                 padding = ImGui::GetStyle().WindowPadding;
    const float width = left.x + gap + right.x, height = std::max(left.y, right.y);
    const float room_x = view_width(input) - 2 * (margin + padding.x),
                room_y = ImGui::GetIO().DisplaySize.y - 2 * (margin + padding.y);
    return std::min(1.0f, std::min(room_x / width, room_y / height));
}

void draw_help(const tl_panel_input &input)
{
    if (input.help_count == 0)
        return;
    const size_t middle = middle_of(input.help, input.help_count);
    const float gap = 2 * ImGui::GetFontSize(), scale = scale_of_help(input, middle, gap);
    tl_panel_place_over_view(input, 0.5f, 0.5f);
    ImGui::SetNextWindowBgAlpha(0.92f);
    ImGui::Begin("help", nullptr, overlay_flags);
    ImGui::SetWindowFontScale(scale);
    ImGui::BeginGroup();
    draw_help_rows("left", input.help, middle);
    ImGui::EndGroup();
    ImGui::SameLine(0, scale * gap);
    ImGui::BeginGroup();
    draw_help_rows("right", input.help + middle, input.help_count - middle);
    ImGui::EndGroup();
    ImGui::End();
}

} // namespace

void tl_panel_place_over_view(const tl_panel_input &input, float x, float y)
{
    const ImGuiIO &io = ImGui::GetIO();
    const float place_x = margin + x * (view_width(input) - 2 * margin);
    const float place_y = margin + y * (io.DisplaySize.y - 2 * margin);
    ImGui::SetNextWindowPos(ImVec2(place_x, place_y), ImGuiCond_Always, ImVec2(x, y));
}

void tl_panel_overlay_draw(const tl_panel_input &input, tl_panel_result &result)
{
    draw_wipe(input);
    draw_marks(input);
    draw_shapes(input);
    draw_status(input);
    draw_notice(input, result);
    draw_legend(input);
    draw_message(input);
    draw_progress(input);
    draw_read_out(input);
    draw_amount(input);
    draw_help(input);
}

void tl_panel_strip_draw(const tl_panel_strip &strip)
{
    const float height = 2.6f * ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    float top_ms = 2 * strip.budget_ms;
    for (size_t i = 0; i < strip.count && strip.budget_ms <= 0; i++)
        top_ms = std::max(top_ms, strip.ms[i]);
    ImDrawList *list = ImGui::GetWindowDrawList();
    list->AddRectFilled(corner, ImVec2(corner.x + width, corner.y + height), IM_COL32(18, 18, 18, 255), 2);
    const float step = width / 120.0f, right = corner.x + width, foot = corner.y + height;
    for (size_t i = 0; i < strip.count && top_ms > 0; i++) {
        const float x = right - static_cast<float>(strip.count - i) * step;
        const float length = height * std::min(strip.ms[i] / top_ms, 1.0f);
        const bool is_over = strip.budget_ms > 0 && strip.ms[i] > 1.1f * strip.budget_ms;
        list->AddRectFilled(ImVec2(x, foot - length), ImVec2(x + 0.75f * step, foot), is_over ? amber : dim);
    }
    if (strip.budget_ms > 0) {
        const float y = foot - 0.5f * height;
        list->AddLine(ImVec2(corner.x, y), ImVec2(right, y), light, 1);
    }
    ImGui::Dummy(ImVec2(width, height));
    /* Two lines are reserved, so that nothing below moves when the label takes one. */
    const ImVec2 label = ImGui::GetCursorPos();
    ImGui::PushTextWrapPos(label.x + width);
    ImGui::TextDisabled("%s", strip.label);
    ImGui::PopTextWrapPos();
    ImGui::SetCursorPos(ImVec2(label.x, label.y + 2 * ImGui::GetTextLineHeight()));
    ImGui::Dummy(ImVec2(0, 0));
}
