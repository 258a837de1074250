#include "render/local/lit_texture.h"

#include "config/base/memory.h"
#include "render/surfaces/uv_texels.h"

#include <epoxy/gl.h>

#include <stdlib.h>

void tl_lit_texture_release(struct tl_lit_texture *lit)
{
    free(lit->charts);
    if (lit->framebuffer)
        glDeleteFramebuffers(1, &lit->framebuffer);
    tl_texture_destroy(&lit->light);
    tl_texture_destroy(&lit->cover);
    *lit = (struct tl_lit_texture){0};
}

size_t tl_lit_texture_bytes(const struct tl_lit_texture *lit)
{
    return tl_texture_bytes(&lit->light) + tl_texture_bytes(&lit->cover);
}

static struct tl_lit_chart make_chart(const tl_surface *surface, size_t index, size_t part, int side)
{
    tl_surface own = *surface;
    own.indices = surface->indices + surface->parts[part].first_index;
    own.index_count = surface->parts[part].index_count;
    struct tl_lit_chart chart = {.surface = index,
                                 .part = part,
                                 .revision = surface->topology_revision,
                                 .side = side,
                                 .fits = tl_uv_texels_fit(&own, side)};
    if (chart.fits)
        tl_uv_texels_box(&own, &chart.low, &chart.extent);
    return chart;
}

const struct tl_lit_chart *tl_lit_texture_chart(struct tl_lit_texture *lit, const tl_surface *surface,
                                                size_t index, size_t part, int side)
{
    size_t i = 0;
    while (i < lit->chart_count && (lit->charts[i].surface != index || lit->charts[i].part != part))
        i++;
    bool is_new = i == lit->chart_count;
    if (is_new)
        lit->charts = tl_resize(lit->charts, ++lit->chart_count, sizeof *lit->charts);
    struct tl_lit_chart *chart = &lit->charts[i];
    if (is_new || chart->revision != surface->topology_revision || chart->side != side)
        *chart = make_chart(surface, index, part, side);
    return chart->fits ? chart : NULL;
}

static void allocate(struct tl_lit_texture *lit, tl_gpu *gpu, int target, int side, int layers)
{
    static const unsigned formats[][2] = {
        [TL_PASS_TARGET_FIXED8] = {GL_RGBA8, GL_R8}, [TL_PASS_TARGET_FLOAT] = {GL_RGBA32F, GL_R32F}};
    static const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    if (!lit->framebuffer) {
        glCreateFramebuffers(1, &lit->framebuffer);
        glNamedFramebufferDrawBuffers(lit->framebuffer, 2, attachments);
    }
    if (lit->light.width == side && lit->light.format == formats[target][0])
        return;
    int levels = tl_texture_full_levels(side, side);
    tl_texture_destroy(&lit->light);
    tl_texture_destroy(&lit->cover);
    lit->light = tl_texture_create(gpu, GL_TEXTURE_2D_ARRAY, formats[target][0], side, side, layers, levels);
    lit->cover = tl_texture_create(gpu, GL_TEXTURE_2D_ARRAY, formats[target][1], side, side, layers, levels);
}

void tl_lit_texture_begin(struct tl_lit_texture *lit, tl_gpu *gpu, int target, int side, int layers,
                          int layer)
{
    const float empty[4] = {0, 0, 0, 0};
    allocate(lit, gpu, target, side, layers);
    glNamedFramebufferTextureLayer(lit->framebuffer, GL_COLOR_ATTACHMENT0, lit->light.id, 0, layer);
    glNamedFramebufferTextureLayer(lit->framebuffer, GL_COLOR_ATTACHMENT1, lit->cover.id, 0, layer);
    glClearNamedFramebufferfv(lit->framebuffer, GL_COLOR, 0, empty);
    glClearNamedFramebufferfv(lit->framebuffer, GL_COLOR, 1, empty);
    glBindFramebuffer(GL_FRAMEBUFFER, lit->framebuffer);
    glViewport(0, 0, side, side);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
}

void tl_lit_texture_end(const struct tl_lit_texture *lit)
{
    glGenerateTextureMipmap(lit->light.id);
    glGenerateTextureMipmap(lit->cover.id);
}
