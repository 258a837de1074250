#include "render/light/light_buffer.h"

#include "config/base/memory.h"

#include <epoxy/gl.h>

#include <stdlib.h>
#include <string.h>

void tl_light_buffer_release(struct tl_light_buffer *buffer)
{
    tl_target_destroy(&buffer->target);
    free(buffer->texels);
    *buffer = (struct tl_light_buffer){0};
}

size_t tl_light_buffer_bytes(const struct tl_light_buffer *buffer)
{
    return tl_target_bytes(&buffer->target) + buffer->bytes;
}

static void allocate(struct tl_light_buffer *buffer, tl_gpu *gpu, const tl_target *gbuffer)
{
    const unsigned format = GL_RGBA32F;
    tl_target_fit(&buffer->target, gpu, gbuffer, &format, 1);
}

void tl_light_buffer_begin(struct tl_light_buffer *buffer, tl_gpu *gpu, const tl_target *gbuffer,
                           bool is_first)
{
    const float black[] = {0, 0, 0, 0};
    allocate(buffer, gpu, gbuffer);
    buffer->is_finished = false;
    if (is_first)
        glClearNamedFramebufferfv(buffer->target.id, GL_COLOR, 0, black);
    glBindFramebuffer(GL_FRAMEBUFFER, buffer->target.id);
    glViewport(0, 0, gbuffer->width, gbuffer->height);
    glEnable(GL_DEPTH_TEST); /* the full-screen triangle lies at depth 1: this keeps to what is covered */
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_FALSE);
    for (GLuint i = 0; i < TL_GBUFFER_TRIANGLE; i++)
        glBindTextureUnit(i, gbuffer->colours[i].id);
}

void tl_light_buffer_clear(struct tl_light_buffer *buffer, int width, int height)
{
    size_t bytes = (size_t)width * (size_t)height * 4 * sizeof(float);
    if (bytes != buffer->bytes) {
        free(buffer->texels);
        buffer->texels = tl_alloc(bytes, 1);
        buffer->bytes = bytes;
    }
    buffer->is_finished = false;
    size_t row_floats = 4 * (size_t)width;
#pragma omp parallel for
    for (int y = 0; y < height; y++)
        memset(buffer->texels + (size_t)y * row_floats, 0, row_floats * sizeof *buffer->texels);
}

void tl_light_buffer_finish(struct tl_light_buffer *buffer, const struct tl_samples *samples)
{
#pragma omp parallel for
    for (size_t i = 0; i < samples->primary_count; i++) {
        float *alpha = buffer->texels + 4 * (size_t)samples->items[i].texel + 3;
        *alpha = samples->items[i].cover - *alpha;
    }
    buffer->is_finished = true;
}

void tl_light_buffer_send(struct tl_light_buffer *buffer, tl_gpu *gpu, const tl_target *gbuffer)
{
    allocate(buffer, gpu, gbuffer);
    glTextureSubImage2D(buffer->target.colours[0].id, 0, 0, 0, gbuffer->width, gbuffer->height, GL_RGBA,
                        GL_FLOAT, buffer->texels);
}
