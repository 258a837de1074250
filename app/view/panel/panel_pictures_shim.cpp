#include "app/view/panel/panel_pictures_shim.h"

#include <epoxy/gl.h>
#include <imgui.h>

#include <cstdint>
#include <map>

struct tl_panel_pictures {
    tl_gpu *gpu;
    tl_panel_list list;
    std::map<const void *, tl_texture> textures; /* by the texels of their image, which stay */
};

namespace
{

const tl_texture &texture_of(tl_panel_pictures *pictures, const tl_image &image)
{
    const auto known = pictures->textures.find(image.texels);
    if (known != pictures->textures.end())
        return known->second;
    tl_texture &made = pictures->textures[image.texels];
    made = tl_texture_create(pictures->gpu, GL_TEXTURE_2D, GL_RGBA8, image.width, image.height, 1, 1);
    tl_texture_fill(&made, 0, &image, false);
    glTextureParameteri(made.id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    return made;
}

} // namespace

tl_panel_pictures *tl_panel_pictures_create(tl_gpu *gpu)
{
    return new tl_panel_pictures{gpu, {}, {}};
}

void tl_panel_pictures_destroy(tl_panel_pictures **pictures)
{
    if (!*pictures)
        return;
    for (auto &texture : (*pictures)->textures)
        tl_texture_destroy(&texture.second);
    delete *pictures;
    *pictures = nullptr;
}

void tl_panel_pictures_follow(tl_panel_pictures *pictures, const tl_panel_list &list)
{
    pictures->list = list;
}

bool tl_panel_pictures_draw(tl_panel_pictures *pictures, const tl_option &row, size_t index)
{
    const tl_panel_list &list = pictures->list;
    if (!list.row || list.row != &row)
        return false;
    const float height = ImGui::GetFontSize() * 3;
    const bool is_made = index < list.count && list.images[index].texels;
    const tl_image *image = is_made ? &list.images[index] : list.count > 0 ? &list.images[0] : nullptr;
    const float ratio =
        image && image->texels ? static_cast<float>(image->width) / static_cast<float>(image->height) : 1;
    const ImVec2 size(height * ratio, height);
    if (is_made)
        ImGui::Image(reinterpret_cast<ImTextureID>(static_cast<intptr_t>(texture_of(pictures, *image).id)),
                     size);
    else
        ImGui::Dummy(size);
    return true;
}
