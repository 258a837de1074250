#include "render/present/picture.h"

#include "config/base/memory.h"

#include <epoxy/gl.h>

#include <stdlib.h>

void tl_picture_release(struct tl_picture *picture)
{
    tl_target_destroy(&picture->target);
    free(picture->bytes);
    *picture = (struct tl_picture){0};
}

size_t tl_picture_bytes(const struct tl_picture *picture)
{
    return tl_target_bytes(&picture->target) + picture->byte_count;
}

bool tl_picture_has(const struct tl_picture *picture, const struct tl_picture_part *part)
{
    return picture->width == part->width && picture->height == part->height &&
           picture->first_column <= part->first_column && picture->end_column >= part->end_column;
}

static void begin(struct tl_picture *picture, const struct tl_picture_part *part)
{
    if (picture->width != part->width || picture->height != part->height)
        tl_target_destroy(&picture->target);
    picture->width = part->width;
    picture->height = part->height;
    picture->first_column = part->first_column;
    picture->end_column = part->end_column;
}

static void allocate_bytes(struct tl_picture *picture, size_t count)
{
    if (count == picture->byte_count)
        return;
    free(picture->bytes);
    picture->bytes = count > 0 ? tl_alloc_lines(count, 1) : NULL;
    picture->byte_count = count;
}

static void allocate_target(struct tl_picture *picture, tl_gpu *gpu)
{
    const unsigned format = GL_RGBA8;
    if (!picture->target.id)
        picture->target = tl_target_create(gpu, picture->width, picture->height, &format, 1, false);
}

uint8_t *tl_picture_begin_cpu(struct tl_picture *picture, const struct tl_picture_part *part)
{
    begin(picture, part);
    allocate_bytes(picture, 4 * (size_t)part->width * (size_t)part->height);
    picture->is_sent = false;
    return picture->bytes;
}

void tl_picture_begin_gpu(struct tl_picture *picture, tl_gpu *gpu, const struct tl_picture_part *part)
{
    begin(picture, part);
    allocate_bytes(picture, 0);
    allocate_target(picture, gpu);
    picture->is_sent = true;
    glBindFramebuffer(GL_FRAMEBUFFER, picture->target.id);
    glViewport(0, 0, picture->width, picture->height);
}

void tl_picture_copy(struct tl_picture *picture, tl_gpu *gpu, unsigned framebuffer, int first_column,
                     int end_column)
{
    if (!picture->is_sent) {
        allocate_target(picture, gpu);
        glTextureSubImage2D(picture->target.colours[0].id, 0, 0, 0, picture->width, picture->height, GL_RGBA,
                            GL_UNSIGNED_BYTE, picture->bytes);
        picture->is_sent = true;
    }
    glBlitNamedFramebuffer(picture->target.id, framebuffer, first_column, 0, end_column, picture->height,
                           first_column, 0, end_column, picture->height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

void tl_picture_read(const struct tl_picture *picture, tl_image *out)
{
    size_t width = (size_t)picture->width, height = (size_t)picture->height, count = 4 * width * height;
    uint8_t *read = NULL;
    const uint8_t *from = picture->bytes;
    if (!from) {
        from = read = tl_alloc(count, 1);
        glGetTextureImage(picture->target.colours[0].id, 0, GL_RGBA, GL_UNSIGNED_BYTE, (GLsizei)count, read);
    }
    *out = tl_image_create(picture->width, picture->height, 3, TL_IMAGE_U8);
    uint8_t *rgb = out->texels;
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++)
            for (size_t c = 0; c < 3; c++)
                rgb[3 * (y * width + x) + c] = from[4 * ((height - 1 - y) * width + x) + c];
    free(read);
}
