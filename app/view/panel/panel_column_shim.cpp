#include "app/view/panel/panel_column_shim.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

struct tl_panel_column {
    tl_gpu *gpu;
    tl_target target;
    uint64_t holds; /* hash of what the target shows; 0: nothing */
};

namespace
{

uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count)
{
    const auto *at = static_cast<const unsigned char *>(bytes);
    for (; count >= 8; count -= 8, at += 8) {
        uint64_t word;
        memcpy(&word, at, 8);
        hash = (hash ^ word) * 0x9E3779B97F4A7C15u;
        hash ^= hash >> 29;
    }
    for (; count > 0; count--, at++)
        hash = (hash ^ *at) * 0x100000001B3u;
    return hash;
}

/* A hash of everything that decides what a list draws; never 0. */
uint64_t hash_of(const ImDrawList &list)
{
    uint64_t hash = hash_bytes(1, list.VtxBuffer.Data, static_cast<size_t>(list.VtxBuffer.size_in_bytes()));
    hash = hash_bytes(hash, list.IdxBuffer.Data, static_cast<size_t>(list.IdxBuffer.size_in_bytes()));
    for (const ImDrawCmd &command : list.CmdBuffer) {
        hash = hash_bytes(hash, &command.ClipRect, sizeof command.ClipRect);
        hash = hash_bytes(hash, &command.ElemCount, sizeof command.ElemCount);
    }
    return hash | 1;
}

/* Draws some of the lists of `data`, as if they were all that there is. */
void draw_lists(const ImDrawData &data, ImDrawList **lists, int count, ImVec2 corner, ImVec2 size)
{
    ImDrawData only = data;
    only.CmdLists = lists;
    only.CmdListsCount = count;
    only.TotalVtxCount = only.TotalIdxCount = 0;
    for (int i = 0; i < count; i++) {
        only.TotalVtxCount += lists[i]->VtxBuffer.Size;
        only.TotalIdxCount += lists[i]->IdxBuffer.Size;
    }
    only.DisplayPos = corner;
    only.DisplaySize = size;
    ImGui_ImplOpenGL3_RenderDrawData(&only);
}

int pixels(float size, float ratio)
{
    return static_cast<int>(std::lround(size * ratio));
}

void resize(tl_panel_column *column, int width, int height)
{
    const unsigned format = GL_RGBA8;
    if (column->target.width == width && column->target.height == height)
        return;
    tl_target_destroy(&column->target);
    column->target = tl_target_create(column->gpu, width, height, &format, 1, false);
    column->holds = 0;
}

/* Draws the panel's window again, unless the target shows the same. */
void renew(tl_panel_column *column, const ImDrawData &data, const tl_panel_column_place &place)
{
    auto *list = const_cast<ImDrawList *>(place.list); /* ImGui's arrays of lists are not const */
    const uint64_t hash = hash_of(*list);
    if (column->holds == hash)
        return;
    glBindFramebuffer(GL_FRAMEBUFFER, column->target.id);
    draw_lists(data, &list, 1, ImVec2(place.x, place.y), ImVec2(place.width, place.height));
    column->holds = hash;
}

void draw_column(tl_panel_column *column, const ImDrawData &data, const tl_panel_column_place &place)
{
    GLint screen;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &screen);
    const ImVec2 ratio = data.FramebufferScale;
    const int width = pixels(place.width, ratio.x), height = pixels(place.height, ratio.y),
              rise = pixels(data.DisplaySize.y - place.y, ratio.y) - height;
    resize(column, width, height);
    renew(column, data, place);
    const int x = pixels(place.x, ratio.x);
    glBlitNamedFramebuffer(column->target.id, static_cast<GLuint>(screen), 0, 0, width, height, x, rise,
                           x + width, rise + height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(screen));
}

} // namespace

tl_panel_column *tl_panel_column_create(tl_gpu *gpu)
{
    return new tl_panel_column{gpu, {}, 0};
}

void tl_panel_column_destroy(tl_panel_column **column)
{
    if (!*column)
        return;
    tl_target_destroy(&(*column)->target);
    delete *column;
    *column = nullptr;
}

void tl_panel_column_forget(tl_panel_column *column)
{
    column->holds = 0;
}

void tl_panel_column_draw(tl_panel_column *column, const ImDrawData &data, const tl_panel_column_place &place)
{
    std::vector<ImDrawList *> others;
    for (int i = 0; i < data.CmdListsCount; i++)
        if (data.CmdLists[i] != place.list)
            others.push_back(data.CmdLists[i]);
    if (place.list)
        draw_column(column, data, place);
    if (!others.empty())
        draw_lists(data, others.data(), static_cast<int>(others.size()), data.DisplayPos, data.DisplaySize);
}
