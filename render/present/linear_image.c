#include "render/present/linear_image.h"

#include "config/base/memory.h"

#include <epoxy/gl.h>

#include <stdlib.h>
#include <string.h>

void tl_linear_image_release(struct tl_linear_image *image)
{
    tl_target_destroy(&image->target);
    free(image->texels);
    *image = (struct tl_linear_image){0};
}

size_t tl_linear_image_bytes(const struct tl_linear_image *image)
{
    return tl_target_bytes(&image->target) + image->bytes;
}

float *tl_linear_image_begin_cpu(struct tl_linear_image *image, int width, int height)
{
    size_t bytes = 4 * sizeof(float) * (size_t)width * (size_t)height;
    if (width != image->width || height != image->height)
        tl_target_destroy(&image->target);
    if (bytes != image->bytes) {
        free(image->texels);
        image->texels = tl_alloc_lines(bytes, 1);
        image->bytes = bytes;
    }
    image->width = width;
    image->height = height;
    image->is_sent = false;
    return image->texels;
}

static void allocate_target(struct tl_linear_image *image, tl_gpu *gpu)
{
    const unsigned format = GL_RGBA32F;
    if (image->target.width == image->width && image->target.height == image->height)
        return;
    tl_target_destroy(&image->target);
    image->target = tl_target_create(gpu, image->width, image->height, &format, 1, false);
}

void tl_linear_image_begin_gpu(struct tl_linear_image *image, tl_gpu *gpu, int width, int height)
{
    free(image->texels);
    image->texels = NULL;
    image->bytes = 0;
    image->width = width;
    image->height = height;
    image->is_sent = true;
    allocate_target(image, gpu);
    glBindFramebuffer(GL_FRAMEBUFFER, image->target.id);
    glViewport(0, 0, width, height);
}

const tl_texture *tl_linear_image_texture(struct tl_linear_image *image, tl_gpu *gpu)
{
    if (!image->is_sent) {
        allocate_target(image, gpu);
        glTextureSubImage2D(image->target.colours[0].id, 0, 0, 0, image->width, image->height, GL_RGBA,
                            GL_FLOAT, image->texels);
        image->is_sent = true;
    }
    return &image->target.colours[0];
}

void tl_linear_image_read(const struct tl_linear_image *image, tl_image *out)
{
    size_t row_floats = 4 * (size_t)image->width, count = row_floats * (size_t)image->height;
    float *read = NULL;
    const float *from = image->texels;
    if (!from) {
        from = read = tl_alloc(count, sizeof *read);
        glGetTextureImage(image->target.colours[0].id, 0, GL_RGBA, GL_FLOAT, (GLsizei)(count * sizeof *read),
                          read);
    }
    *out = tl_image_create(image->width, image->height, 4, TL_IMAGE_F32);
    float *rows = out->texels;
    for (size_t y = 0; y < (size_t)image->height; y++)
        memcpy(rows + y * row_floats, from + ((size_t)image->height - 1 - y) * row_floats,
               row_floats * sizeof *rows);
    free(read);
}
