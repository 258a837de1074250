#include "tests/app/view/panel/column_shim.h"

#include "app/view/panel/panel_column_shim.h"

#include <backends/imgui_impl_opengl3.h>
#include <cstdint>
#include <epoxy/gl.h>
#include <imgui.h>
#include <vector>

struct column_stage {
    tl_panel_column *column;
    tl_target screen;
};

column_stage *column_begin(tl_gpu *gpu)
{
    const unsigned format = GL_RGBA8;
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    io.DisplaySize = ImVec2(COLUMN_SIDE, COLUMN_SIDE);
    io.IniFilename = nullptr;
    ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 1; /* as the panel's */
    ImGui_ImplOpenGL3_Init("#version 450 core");
    return new column_stage{tl_panel_column_create(gpu),
                            tl_target_create(gpu, COLUMN_SIDE, COLUMN_SIDE, &format, 1, false)};
}

void column_end(column_stage **stage)
{
    tl_panel_column_destroy(&(*stage)->column);
    tl_target_destroy(&(*stage)->screen);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
    delete *stage;
    *stage = nullptr;
}

unsigned column_show(column_stage *stage, const char *text)
{
    const ImVec2 corner(0, 0), size(COLUMN_SIDE, COLUMN_SIDE);
    std::vector<uint8_t> bytes(static_cast<size_t>(4 * COLUMN_SIDE) * COLUMN_SIDE);
    ImGui::GetIO().DeltaTime = 1 / 60.0f;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    ImGui::SetNextWindowPos(corner);
    ImGui::SetNextWindowSize(size);
    ImGui::Begin("column", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::TextUnformatted(text);
    const tl_panel_column_place place = {ImGui::GetWindowDrawList(), corner.x, corner.y, size.x, size.y};
    ImGui::End();
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, stage->screen.id);
    glViewport(0, 0, COLUMN_SIDE, COLUMN_SIDE);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    tl_panel_column_draw(stage->column, *ImGui::GetDrawData(), place);
    glReadPixels(0, 0, COLUMN_SIDE, COLUMN_SIDE, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    unsigned sum = 0;
    for (uint8_t byte : bytes)
        sum += byte;
    return sum;
}

void column_fill_glyphs(column_stage *stage, bool forgets)
{
    const uint8_t full[4] = {255, 255, 255, 255};
    const auto glyphs = static_cast<GLuint>(reinterpret_cast<intptr_t>(ImGui::GetIO().Fonts->TexID));
    glClearTexImage(glyphs, 0, GL_RGBA, GL_UNSIGNED_BYTE, full);
    if (forgets)
        tl_panel_column_forget(stage->column);
}
