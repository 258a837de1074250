extern "C" {
#include "app/view/panel/panel_shim.h"
#include "app/view/panel/panel_rows_shim.h"
}
#include "app/view/panel/panel_column_shim.h"
#include "app/view/panel/panel_font_shim.h"
#include "app/view/panel/panel_inputs_shim.h"
#include "app/view/panel/panel_overlay_shim.h"
#include "app/view/panel/panel_pictures_shim.h"
#include "app/view/panel/panel_text_shim.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <cfloat>
#include <cstdio>
#include <cstring>
#include <initializer_list>

struct tl_panel {
    tl_panel_fonts *fonts;
    tl_panel_column *column;
    tl_panel_pictures *pictures;
    tl_panel_inputs *inputs;
    tl_panel_column_place place;    /* of the last frame that was built */
    bool has_platform, has_drawing; /* whether ImGui's backends are initialised */
    bool uses_keys, takes_focus;    /* takes_focus: in the next frame */
};

namespace
{

const float font_size = 15.0f;
const ImGuiPopupFlags any_popup = ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel;

/* Neutral greys: a coloured surround would bias the judgement of the cloth's colour. */
void choose_style(float scale)
{
    ImGui::StyleColorsDark();
    ImGuiStyle &style = ImGui::GetStyle();
    const auto grey = [](float level, float alpha) { return ImVec4(level, level, level, alpha); };
    style.Colors[ImGuiCol_WindowBg] = grey(0.13f, 1.0f);
    style.Colors[ImGuiCol_PopupBg] = grey(0.10f, 0.97f);
    style.Colors[ImGuiCol_Border] = grey(0.28f, 1.0f);
    style.Colors[ImGuiCol_FrameBg] = grey(0.21f, 1.0f);
    style.Colors[ImGuiCol_FrameBgHovered] = grey(0.27f, 1.0f);
    style.Colors[ImGuiCol_FrameBgActive] = grey(0.31f, 1.0f);
    style.Colors[ImGuiCol_TitleBgActive] = grey(0.18f, 1.0f);
    style.Colors[ImGuiCol_Button] = grey(0.27f, 1.0f);
    style.Colors[ImGuiCol_ButtonHovered] = grey(0.35f, 1.0f);
    style.Colors[ImGuiCol_ButtonActive] = grey(0.42f, 1.0f);
    style.Colors[ImGuiCol_Header] = grey(0.20f, 1.0f);
    style.Colors[ImGuiCol_HeaderHovered] = grey(0.27f, 1.0f);
    style.Colors[ImGuiCol_HeaderActive] = grey(0.31f, 1.0f);
    style.Colors[ImGuiCol_SliderGrab] = grey(0.52f, 1.0f);
    style.Colors[ImGuiCol_SliderGrabActive] = grey(0.70f, 1.0f);
    style.Colors[ImGuiCol_CheckMark] = grey(0.85f, 1.0f);
    style.Colors[ImGuiCol_Text] = grey(0.90f, 1.0f);
    style.Colors[ImGuiCol_TextDisabled] = grey(0.58f, 1.0f);
    style.Colors[ImGuiCol_ModalWindowDimBg] = grey(0.0f, 0.35f);
    style.WindowRounding = 0;
    style.FrameRounding = 3;
    style.GrabRounding = 2;
    style.ItemSpacing = ImVec2(6, 4);
    style.CellPadding = ImVec2(3, 2);
    style.WindowPadding = ImVec2(10, 8);
    style.ScaleAllSizes(scale);
}

void tooltip_of_last_item(const char *help)
{
    if (help && help[0] && ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", help);
}

/* Buttons in a row, wrapped at the panel's edge. */
void draw_buttons(const tl_panel_button *buttons, size_t count, tl_panel_result &result)
{
    const ImGuiStyle &style = ImGui::GetStyle();
    const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    for (size_t i = 0; i < count; i++) {
        const float width = ImGui::CalcTextSize(buttons[i].label).x + 2 * style.FramePadding.x;
        if (i > 0 && ImGui::GetItemRectMax().x + style.ItemSpacing.x + width <= end)
            ImGui::SameLine();
        if (ImGui::Button(buttons[i].label))
            result.button = static_cast<int>(i);
        tooltip_of_last_item(buttons[i].help);
    }
}

void draw_timeline(const tl_panel_timeline &timeline, tl_panel_result &result)
{
    int frame = timeline.frame < timeline.last ? timeline.frame : timeline.last;
    if (timeline.last <= 0)
        return;
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderInt("##frame", &frame, 0, timeline.last, timeline.label, ImGuiSliderFlags_NoInput))
        result.frame = frame;
    tooltip_of_last_item("the frame of the motion: drag to go to another one");
}

/* "table.key" among the bindings. */
bool draw_favourite(const tl_panel &panel, const tl_panel_input &input, const char *name,
                    tl_panel_result &result)
{
    for (size_t i = 0; i < input.binding_count; i++) {
        const tl_option_table &table = *input.bindings[i].table;
        const size_t prefix = strlen(table.name);
        if (strncmp(name, table.name, prefix) != 0 || name[prefix] != '.')
            continue;
        for (size_t row = 0; row < table.row_count; row++)
            if (strcmp(name + prefix + 1, table.rows[row].name) == 0)
                return tl_panel_row(&input.bindings[i], &table.rows[row], panel.pictures, &result);
    }
    return false;
}

void draw_front(const tl_panel &panel, const tl_panel_input &input, tl_panel_result &result)
{
    if (!tl_panel_rows_begin("front"))
        return;
    ImGui::PushID("favourites");
    for (size_t i = 0; i < input.favourite_count; i++)
        result.changed |= draw_favourite(panel, input, input.favourites[i], result);
    ImGui::PopID();
    tl_panel_rows_end();
}

void draw_lines(const tl_panel_lines &group)
{
    const int flags = group.open ? ImGuiTreeNodeFlags_DefaultOpen : 0;
    const bool is_open = ImGui::CollapsingHeader(group.title, flags);
    tooltip_of_last_item(group.help);
    if (!is_open || !ImGui::BeginTable(group.title, group.columns, ImGuiTableFlags_None))
        return;
    for (int column = 0; column < group.columns; column++)
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch,
                                column + 1 < group.columns ? 1.0f : 2.4f);
    for (size_t i = 0; i < group.count; i++) {
        ImGui::TableNextRow();
        for (int column = 0; column < group.columns; column++) {
            ImGui::TableNextColumn();
            if (column == 0)
                ImGui::TextDisabled("%s", group.lines[i].cells[column]);
            else
                ImGui::TextWrapped("%s", group.lines[i].cells[column]);
        }
    }
    ImGui::EndTable();
}

void draw_table(const tl_panel &panel, const tl_binding &binding, tl_panel_result &result)
{
    const tl_option_table &table = *binding.table;
    int changed_count = 0;
    for (size_t i = 0; i < table.row_count; i++)
        changed_count += tl_panel_row_changed(&binding, &table.rows[i]);
    char label[128]; /* ImGui takes the part after ### as the identity: a new count does not close the header
                      */
    if (changed_count > 0)
        snprintf(label, sizeof label, "%s (%d changed)###%s", table.name, changed_count, table.name);
    else
        snprintf(label, sizeof label, "%s###%s", table.name, table.name);
    const bool is_open = ImGui::CollapsingHeader(label);
    tooltip_of_last_item(table.help);
    if (!is_open || !tl_panel_rows_begin(table.name))
        return;
    for (size_t i = 0; i < table.row_count; i++)
        result.changed |= tl_panel_row(&binding, &table.rows[i], panel.pictures, &result);
    tl_panel_rows_end();
}

void draw_panel(tl_panel &panel, const tl_panel_input &input, tl_panel_result &result)
{
    const ImVec2 ratio = ImGui::GetIO().DisplayFramebufferScale;
    ImGui::SetNextWindowPos(
        ImVec2(static_cast<float>(input.x) / ratio.x, static_cast<float>(input.y) / ratio.y));
    ImGui::SetNextWindowSize(
        ImVec2(static_cast<float>(input.width) / ratio.x, static_cast<float>(input.height) / ratio.y));
    if (panel.takes_focus)
        ImGui::SetNextWindowFocus();
    panel.takes_focus = false;
    ImGui::Begin("panel", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    panel.place = {ImGui::GetWindowDrawList(), corner.x, corner.y, size.x, size.y};
    ImGui::PushAllowKeyboardFocus(
        false); /* Tab hides the panel and must not move the keyboard focus into it */
    ImGui::TextWrapped("%s", input.title);
    draw_buttons(input.buttons, input.button_count, result);
    draw_timeline(input.timeline, result);
    tl_panel_strip_draw(input.strip);
    ImGui::Separator();
    draw_front(panel, input, result);
    ImGui::Separator();
    for (size_t i = 0; i < input.measure_count; i++)
        draw_lines(input.measures[i]);
    ImGui::Separator();
    ImGui::TextDisabled("All options");
    for (size_t i = 0; i < input.binding_count; i++)
        draw_table(panel, input.bindings[i], result);
    ImGui::PopAllowKeyboardFocus();
    ImGui::End();
}

void draw_question(const tl_panel_input &input, tl_panel_result &result)
{
    if (!ImGui::IsPopupOpen("question"))
        ImGui::OpenPopup("question");
    tl_panel_place_over_view(input, 0.5f, 0.5f);
    if (!ImGui::BeginPopupModal("question", nullptr,
                                ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                                    ImGuiWindowFlags_NoSavedSettings))
        return;
    ImGui::TextUnformatted(input.question);
    for (size_t i = 0; i < input.answer_count; i++) {
        if (i > 0 && !input.answers_below)
            ImGui::SameLine();
        char label[160];
        snprintf(label, sizeof label, "%d  %s", (static_cast<int>(i) + 1) % 10, input.answers[i].label);
        if (ImGui::Button(label))
            result.answer = static_cast<int>(i);
        tooltip_of_last_item(input.answers[i].help);
    }
    if (result.answer >= 0)
        ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

void note_lines(tl_panel_fonts *fonts, const tl_panel_line *lines, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (const auto &cell : lines[i].cells)
            tl_panel_fonts_note(fonts, cell);
}

/* Every text that may hold a name: a file's, a material's, a part's. Labels and help of options are ASCII. */
void note_texts(tl_panel_fonts *fonts, const tl_panel_input &input)
{
    for (const char *text :
         {input.title, input.message, input.status, input.notice, input.strip.label, input.wipe.left,
          input.wipe.right, input.progress.what, input.read_out, input.amount, input.question})
        tl_panel_fonts_note(fonts, text);
    for (size_t i = 0; i < input.measure_count; i++)
        note_lines(fonts, input.measures[i].lines, input.measures[i].count);
    note_lines(fonts, input.help, input.help_count);
    for (int i = 0; input.legend && i < input.legend->entry_count; i++)
        tl_panel_fonts_note(fonts, input.legend->entry_labels[i]);
    for (size_t i = 0; i < input.binding_count; i++)
        for (size_t row = 0; row < input.bindings[i].table->row_count; row++)
            tl_panel_fonts_note(fonts,
                                tl_panel_row_text(&input.bindings[i], &input.bindings[i].table->rows[row]));
}

} // namespace

struct tl_panel *tl_panel_create(struct GLFWwindow *window, tl_gpu *gpu, float scale, tl_error *error)
{
    tl_panel *panel = new tl_panel{};
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; /* ImGui must not write a file of its own */
    panel->fonts = tl_panel_fonts_create(font_size * scale, scale);
    panel->column = tl_panel_column_create(gpu);
    panel->pictures = tl_panel_pictures_create(gpu);
    panel->inputs = tl_panel_inputs_create();
    choose_style(scale);
    panel->has_platform = ImGui_ImplGlfw_InitForOpenGL(window, false);
    panel->has_drawing = panel->has_platform && ImGui_ImplOpenGL3_Init("#version 450 core");
    if (!panel->has_drawing) {
        tl_fail(error, TL_DEVICE, "the panel cannot be drawn with this OpenGL: update the graphics driver");
        tl_panel_destroy(&panel);
    }
    return panel;
}

void tl_panel_destroy(tl_panel **panel)
{
    if (!*panel)
        return;
    if ((*panel)->has_drawing)
        ImGui_ImplOpenGL3_Shutdown();
    if ((*panel)->has_platform)
        ImGui_ImplGlfw_Shutdown();
    tl_panel_column_destroy(&(*panel)->column);
    tl_panel_pictures_destroy(&(*panel)->pictures);
    tl_panel_inputs_destroy(&(*panel)->inputs);
    tl_panel_fonts_destroy(&(*panel)->fonts);
    ImGui::DestroyContext();
    delete *panel;
    *panel = nullptr;
}

/* ImGui's own WantCaptureMouse is where the pointer was in the last frame: in a slow one it has moved since.
 */
bool tl_panel_wants_pointer(const tl_panel *panel, float x, float y)
{
    (void)panel;
    const ImGuiIO &io = ImGui::GetIO();
    const bool is_held = io.MouseDown[0] || io.MouseDown[1] || io.MouseDown[2];
    if (ImGui::IsPopupOpen(nullptr, any_popup) || (is_held && io.WantCaptureMouse))
        return true;
    const ImVec2 at(x / io.DisplayFramebufferScale.x, y / io.DisplayFramebufferScale.y);
    for (const ImGuiWindow *window : ImGui::GetCurrentContext()->Windows)
        if (window->Active && !window->Hidden && !(window->Flags & ImGuiWindowFlags_NoMouseInputs) &&
            window->Rect().Contains(at))
            return true;
    return false;
}

bool tl_panel_wants_keys(const tl_panel *panel)
{
    return panel->uses_keys || ImGui::GetIO().WantTextInput;
}

void tl_panel_take(tl_panel *panel, const struct tl_window_event *event)
{
    tl_panel_inputs_take(panel->inputs, *event);
}

bool tl_panel_close(tl_panel *panel)
{
    (void)panel;
    if (!ImGui::IsPopupOpen(nullptr, any_popup))
        return false;
    ImGui::ClosePopupToLevel(0, true);
    return true;
}

void tl_panel_use_keys(tl_panel *panel, bool used)
{
    ImGuiIO &io = ImGui::GetIO();
    panel->uses_keys = panel->takes_focus = used;
    if (used)
        io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    else
        io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
}

struct tl_panel_result tl_panel_build(tl_panel *panel, const struct tl_panel_input *input)
{
    tl_panel_result result = {false, false, false, -1, -1, -1, -1, {}, nullptr};
    ImGui_ImplOpenGL3_NewFrame();
    note_texts(panel->fonts, *input);
    if (tl_panel_fonts_update(panel->fonts)) {
        ImGui_ImplOpenGL3_DestroyFontsTexture();
        ImGui_ImplOpenGL3_CreateFontsTexture();
        tl_panel_column_forget(panel->column);
    }
    ImGui_ImplGlfw_NewFrame();
    result.behind = tl_panel_inputs_apply(panel->inputs);
    ImGui::NewFrame();
    tl_panel_forget_text();
    tl_panel_pictures_follow(panel->pictures, input->list);
    panel->place = {};
    if (input->width > 0)
        draw_panel(*panel, *input, result);
    tl_panel_overlay_draw(*input, result);
    if (input->question)
        draw_question(*input, result);
    result.editing = ImGui::IsAnyItemActive();
    ImGui::Render();
    return result;
}

void tl_panel_draw(tl_panel *panel)
{
    tl_panel_column_draw(panel->column, *ImGui::GetDrawData(), panel->place);
}
