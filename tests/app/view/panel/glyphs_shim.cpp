#include "tests/app/view/panel/glyphs_shim.h"

#include <imgui.h>
#include <imgui_internal.h>

void glyphs_begin(void)
{
    ImGui::CreateContext();
}

void glyphs_end(void)
{
    ImGui::DestroyContext();
}

int glyphs_missing(const char *text)
{
    const ImFont &font = *ImGui::GetIO().Fonts->Fonts[0];
    int missing = 0;
    while (*text) {
        unsigned point = 0;
        text += ImTextCharFromUtf8(&point, text, nullptr);
        missing += font.FindGlyphNoFallback(static_cast<ImWchar>(point)) == nullptr;
    }
    return missing;
}

int glyphs_atlas_texels(void)
{
    const ImFontAtlas &atlas = *ImGui::GetIO().Fonts;
    return atlas.TexWidth * atlas.TexHeight;
}
