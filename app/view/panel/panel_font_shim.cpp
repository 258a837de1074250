#include "app/view/panel/panel_font_shim.h"

extern "C" {
#include "config/base/log.h"
}

#include <fontconfig/fontconfig.h>
#include <freetype/freetype.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <set>
#include <string>
#include <vector>

namespace
{

/* A font file, and which of the wanted code points are taken from it. */
struct face {
    std::string file;
    int index; /* of the face in a collection */
    ImVector<ImWchar> ranges;
};

/* First and last code points: Latin-1 and Latin Extended-A, dashes, quotes and the ellipsis. */
const unsigned base_ranges[][2] = {{0x20, 0x7e}, {0xa0, 0x17f}, {0x2010, 0x2027}};

/* Outlines of a fixed weight: what ImGui's rasteriser reads. */
bool is_usable(FcPattern *font, face &out)
{
    FcChar8 *file;
    int index;
    FcBool outline, variable;
    if (FcPatternGetString(font, FC_FILE, 0, &file) != FcResultMatch ||
        FcPatternGetInteger(font, FC_INDEX, 0, &index) != FcResultMatch ||
        FcPatternGetBool(font, FC_OUTLINE, 0, &outline) != FcResultMatch || !outline)
        return false;
    if (FcPatternGetBool(font, FC_VARIABLE, 0, &variable) == FcResultMatch && variable)
        return false;
    out.file = reinterpret_cast<const char *>(file);
    out.index = index & 0xffff; /* the upper half names an instance of a variable font */
    return true;
}

/* The system's sans-serif fonts in the user's order of preference. */
FcFontSet *sort_fonts()
{
    FcPattern *pattern = FcNameParse(reinterpret_cast<const FcChar8 *>("sans-serif:weight=80:slant=0"));
    FcConfigSubstitute(nullptr, pattern, FcMatchPattern);
    FcDefaultSubstitute(pattern);
    FcResult result;
    FcFontSet *fonts = FcFontSort(nullptr, pattern, FcTrue, nullptr, &result);
    FcPatternDestroy(pattern);
    return fonts;
}

/* Takes each code point from the first font that has it; `wanted` keeps those that no font has. */
std::vector<face> choose_faces(std::set<unsigned> &wanted)
{
    std::vector<face> faces;
    FcFontSet *fonts = sort_fonts();
    for (int i = 0; fonts && i < fonts->nfont && !wanted.empty(); i++) {
        FcCharSet *covered;
        face next;
        if (!is_usable(fonts->fonts[i], next) ||
            FcPatternGetCharSet(fonts->fonts[i], FC_CHARSET, 0, &covered) != FcResultMatch)
            continue;
        ImFontGlyphRangesBuilder builder;
        const size_t before = wanted.size();
        for (auto point = wanted.begin(); point != wanted.end();)
            if (FcCharSetHasChar(covered, *point)) {
                builder.AddChar(static_cast<ImWchar>(*point));
                point = wanted.erase(point);
            } else {
                ++point;
            }
        if (wanted.size() == before)
            continue;
        builder.BuildRanges(&next.ranges);
        faces.push_back(next);
    }
    if (fonts)
        FcFontSetDestroy(fonts);
    return faces;
}

/* A face's line height over its em, as the rasteriser counts it: ImGui sizes fonts by their lines. */
float line_per_em(FT_Library library, const face &of)
{
    FT_Face opened;
    if (FT_New_Face(library, of.file.c_str(), of.index, &opened) != 0)
        return 1;
    const float line = static_cast<float>(opened->ascender - opened->descender);
    const float em = static_cast<float>(opened->units_per_EM);
    FT_Done_Face(opened);
    return em > 0 && line > 0 ? line / em : 1;
}

/* Sizes for the faces so that their ems are equal: lines of fonts for Chinese, Japanese and Korean are half
 * as high again as an em, and their letters would be a third smaller than the Latin ones. */
std::vector<float> choose_sizes(const std::vector<face> &faces, float pixels)
{
    std::vector<float> sizes;
    FT_Library library;
    if (FT_Init_FreeType(&library) != 0)
        return std::vector<float>(faces.size(), pixels);
    for (const face &next : faces)
        sizes.push_back(line_per_em(library, next));
    FT_Done_FreeType(library);
    const float em = sizes.empty() ? 0 : pixels / sizes[0];
    for (float &size : sizes)
        size *= em;
    return sizes;
}

} // namespace

struct tl_panel_fonts {
    float pixels, scale;
    std::set<unsigned> points;  /* all that were noted; the atlas has them, or no font does */
    std::set<unsigned> missing; /* those that no font has: reported */
    bool is_complete;           /* the atlas was built since a code point was added */
};

namespace
{

/* Each code point once: a rebuild reports those that came with it. */
void report_missing(const std::set<unsigned> &missing, tl_panel_fonts &fonts)
{
    for (const unsigned point : missing)
        if (fonts.missing.insert(point).second)
            tl_info("view: no font has U+%04X: install one that does, for example from the package "
                    "fonts-noto-cjk",
                    point);
}

void build(tl_panel_fonts &fonts)
{
    ImFontAtlas &atlas = *ImGui::GetIO().Fonts;
    std::set<unsigned> missing = fonts.points;
    const std::vector<face> faces = choose_faces(missing);
    atlas.Clear();
    const std::vector<float> sizes = choose_sizes(faces, fonts.pixels);
    for (size_t i = 0; i < faces.size(); i++) {
        const face &next = faces[i];
        ImFontConfig config;
        config.MergeMode = atlas.Fonts.Size > 0; /* one font of ImGui's, with glyphs of several faces */
        config.FontNo = next.index;
        atlas.AddFontFromFileTTF(next.file.c_str(), sizes[i], &config, next.ranges.Data);
    }
    if (atlas.Fonts.Size == 0) {
        atlas.AddFontDefault();
        ImGui::GetIO().FontGlobalScale = fonts.scale;
    }
    atlas.Build();
    atlas.ClearInputData(); /* a CJK font's file is 20 MB */
    report_missing(missing, fonts);
    fonts.is_complete = true;
}

} // namespace

tl_panel_fonts *tl_panel_fonts_create(float pixels, float scale)
{
    tl_panel_fonts *fonts = new tl_panel_fonts{pixels, scale, {}, {}, false};
    for (const auto &range : base_ranges)
        for (unsigned point = range[0]; point <= range[1]; point++)
            fonts->points.insert(point);
    build(*fonts);
    return fonts;
}

void tl_panel_fonts_destroy(tl_panel_fonts **fonts)
{
    delete *fonts;
    *fonts = nullptr;
}

void tl_panel_fonts_note(tl_panel_fonts *fonts, const char *text)
{
    while (text && *text) {
        unsigned point = 0;
        text += ImTextCharFromUtf8(&point, text, nullptr);
        /* ImGui's characters have 16 bits; what lies above is drawn as "?". */
        if (point >= 0x20 && point <= IM_UNICODE_CODEPOINT_MAX && point != IM_UNICODE_CODEPOINT_INVALID &&
            fonts->points.insert(point).second)
            fonts->is_complete = false;
    }
}

bool tl_panel_fonts_update(tl_panel_fonts *fonts)
{
    if (fonts->is_complete)
        return false;
    build(*fonts);
    return true;
}
