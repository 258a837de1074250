#include "render/gpu/context.h"

#include "config/base/memory.h"
#include "config/colour/srgb.h"
#include "render/gpu/map_texture.h"

#include <assert.h>

static size_t texel_bytes(GLenum format)
{
    static const struct {
        GLenum format;
        size_t bytes;
    } sizes[] = {
        {GL_R8, 1},       {GL_RG8, 2},     {GL_RGBA8, 4}, {GL_SRGB8_ALPHA8, 4}, {GL_RGBA16F, 8},
        {GL_RGBA32F, 16}, {GL_RG32F, 8},   {GL_R32F, 4},  {GL_RG16F, 4},        {GL_DEPTH_COMPONENT32F, 4},
        {GL_R32UI, 4},    {GL_RGB9_E5, 4}, {GL_R16, 2},   {GL_RG16, 4},         {GL_RGBA16, 8},
        {GL_R8UI, 1},     {GL_RG32UI, 8},
    };
    for (size_t i = 0; i < TL_COUNT(sizes); i++)
        if (sizes[i].format == format)
            return sizes[i].bytes;
    assert(!"a format that no pass uses");
    return 0;
}

static int level_side(int side, int level)
{
    return side >> level > 1 ? side >> level : 1;
}

size_t tl_texture_bytes(const tl_texture *texture)
{
    if (texture->id == 0)
        return 0;
    size_t texels = 0;
    for (int level = 0; level < texture->levels; level++)
        texels += (size_t)level_side(texture->width, level) * (size_t)level_side(texture->height, level);
    return texels * (size_t)texture->layers * texel_bytes(texture->format);
}

int tl_texture_full_levels(int width, int height)
{
    int levels = 1;
    for (int side = width > height ? width : height; side > 1; side /= 2)
        levels++;
    return levels;
}

tl_texture tl_texture_create(tl_gpu *gpu, unsigned target, unsigned format, int width, int height, int layers,
                             int levels)
{
    tl_texture texture = {.gpu = gpu,
                          .target = target,
                          .format = format,
                          .width = width,
                          .height = height,
                          .layers = layers,
                          .levels = levels};
    glCreateTextures(target, 1, &texture.id);
    if (target == GL_TEXTURE_2D || target == GL_TEXTURE_CUBE_MAP)
        glTextureStorage2D(texture.id, levels, format, width, height);
    else
        glTextureStorage3D(texture.id, levels, format, width, height, layers);
    GLint near = format == GL_R32UI ? GL_NEAREST : GL_LINEAR; /* integers with a filter read as nothing */
    glTextureParameteri(texture.id, GL_TEXTURE_MAG_FILTER, near);
    glTextureParameteri(texture.id, GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : near);
    glTextureParameteri(texture.id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(texture.id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gpu->bytes += tl_texture_bytes(&texture);
    return texture;
}

void tl_texture_destroy(tl_texture *texture)
{
    if (texture->id) {
        texture->gpu->bytes -= tl_texture_bytes(texture);
        glDeleteTextures(1, &texture->id);
    }
    *texture = (tl_texture){0};
}

static void fill_level(const tl_texture *texture, int level, int layer, unsigned type, int channels,
                       const void *texels)
{
    static const GLenum formats[] = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
    GLenum format = formats[channels - 1];
    int width = level_side(texture->width, level), height = level_side(texture->height, level);
    if (texture->target == GL_TEXTURE_2D)
        glTextureSubImage2D(texture->id, level, 0, 0, width, height, format, type, texels);
    else
        glTextureSubImage3D(texture->id, level, 0, 0, layer, width, height, 1, format, type, texels);
}

/* GL takes texels of an sRGB format as encoded; alpha is never. */
static void encode(float *texels, size_t count, int channels)
{
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < channels && c < 3; c++)
            texels[i * (size_t)channels + (size_t)c] =
                tl_srgb_from_linear(texels[i * (size_t)channels + (size_t)c]);
}

/* Not by glGenerateTextureMipmap: software GL compiles shaders of its own for each format first, a tenth to a
 * third of a second. */
void tl_texture_fill(const tl_texture *texture, int layer, const tl_image *image, bool colour)
{
    assert(image->width == texture->width && image->height == texture->height);
    struct tl_map_texture levels = tl_map_texture_make(image, colour);
    fill_level(texture, 0, layer, image->type == TL_IMAGE_F32 ? GL_FLOAT : GL_UNSIGNED_BYTE, image->channels,
               image->texels);
    for (int level = 1; level < texture->levels; level++) {
        if (texture->format == GL_SRGB8_ALPHA8)
            encode(levels.levels[level], (size_t)levels.widths[level] * (size_t)levels.heights[level],
                   image->channels);
        fill_level(texture, level, layer, GL_FLOAT, image->channels, levels.levels[level]);
    }
    tl_map_texture_release(&levels);
}

tl_target tl_target_create(tl_gpu *gpu, int width, int height, const unsigned *formats, int colour_count,
                           bool depth)
{
    assert(colour_count <= TL_TARGET_COLOURS_MAX);
    tl_target target = {.width = width, .height = height, .colour_count = colour_count};
    GLenum attachments[TL_TARGET_COLOURS_MAX];
    glCreateFramebuffers(1, &target.id);
    for (int i = 0; i < colour_count; i++) {
        target.colours[i] = tl_texture_create(gpu, GL_TEXTURE_2D, formats[i], width, height, 1, 1);
        attachments[i] = GL_COLOR_ATTACHMENT0 + (GLenum)i;
        glNamedFramebufferTexture(target.id, attachments[i], target.colours[i].id, 0);
    }
    glNamedFramebufferDrawBuffers(target.id, colour_count, attachments);
    if (depth) {
        target.depth = tl_texture_create(gpu, GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F, width, height, 1, 1);
        glNamedFramebufferTexture(target.id, GL_DEPTH_ATTACHMENT, target.depth.id, 0);
    }
    return target;
}

void tl_target_fit(tl_target *target, tl_gpu *gpu, const tl_target *like, const unsigned *formats,
                   int colour_count)
{
    bool fits = target->width == like->width && target->height == like->height &&
                target->colour_count == colour_count;
    for (int i = 0; fits && i < colour_count; i++)
        fits = target->colours[i].format == formats[i];
    if (!fits) {
        tl_target_destroy(target);
        *target = tl_target_create(gpu, like->width, like->height, formats, colour_count, false);
    }
    glNamedFramebufferTexture(target->id, GL_DEPTH_ATTACHMENT, like->depth.id, 0);
}

void tl_target_destroy(tl_target *target)
{
    for (int i = 0; i < target->colour_count; i++)
        tl_texture_destroy(&target->colours[i]);
    tl_texture_destroy(&target->depth);
    if (target->id)
        glDeleteFramebuffers(1, &target->id);
    *target = (tl_target){0};
}

size_t tl_target_bytes(const tl_target *target)
{
    size_t bytes = tl_texture_bytes(&target->depth);
    for (int i = 0; i < target->colour_count; i++)
        bytes += tl_texture_bytes(&target->colours[i]);
    return bytes;
}
