/* The light of every sample: a target of the GPU that shares the G-buffer's depth, and the same on the CPU
 * for light that is composed there, which stays there unless a pass of the GPU adds to it. RGBA32F, linear,
 * premultiplied by coverage; alpha: how much of the coverage is looked through. Needs the context of its
 * tl_gpu. */
#ifndef TOILE_RENDER_LIGHT_LIGHT_BUFFER_H
#define TOILE_RENDER_LIGHT_LIGHT_BUFFER_H

#include "render/gbuffer/gbuffer.h"
#include "render/gbuffer/samples.h"

struct tl_light_buffer {
    tl_target target;
    float *texels;    /* [height][width][4] of samples, rows upwards; NULL until tl_light_buffer_clear */
    size_t bytes;     /* of these */
    bool is_finished; /* the light is in the texels, whose alpha is coverage */
};

void tl_light_buffer_release(struct tl_light_buffer *buffer);
size_t tl_light_buffer_bytes(const struct tl_light_buffer *buffer);

/* Makes the target as large as the G-buffer and binds it, with the G-buffer's layers in the first units, so
 * that what is drawn over it (at depth 1) keeps to the samples that are covered. Clears it when this is the
 * first round of an image. */
void tl_light_buffer_begin(struct tl_light_buffer *buffer, tl_gpu *gpu, const tl_target *gbuffer,
                           bool is_first);

/* Makes the texels on the CPU as many as these samples, and black. */
void tl_light_buffer_clear(struct tl_light_buffer *buffer, int width, int height);
/* Finishes light on the CPU: alpha becomes the coverage that is not looked through. */
void tl_light_buffer_finish(struct tl_light_buffer *buffer, const struct tl_samples *samples);
/* Makes the target as large as the G-buffer and sends these texels to it, in place of finishing them. */
void tl_light_buffer_send(struct tl_light_buffer *buffer, tl_gpu *gpu, const tl_target *gbuffer);

#endif
