/* The finished linear image: RGBA, premultiplied, coverage in alpha, rows upwards as GL has them. It is made
 * on the CPU or on the GPU and read from the side that holds it; the GPU's copy of an image of the CPU is
 * made when a pass asks for it. Sizes in pixels. Threads: that of the tl_gpu's context. */
#ifndef TOILE_RENDER_PRESENT_LINEAR_IMAGE_H
#define TOILE_RENDER_PRESENT_LINEAR_IMAGE_H

#include "render/gpu/gpu.h"

struct tl_linear_image {
    int width, height; /* 0 before the first image */
    float *texels;     /* [height][width][4], aligned to TL_CACHE_LINE; NULL: the image is on the GPU alone */
    size_t bytes;      /* of these */
    tl_target target;  /* RGBA32F, as large as the image; id 0: the image is on the CPU alone */
    bool is_sent;      /* the target holds the image */
};

/* Begins an image on the CPU: the caller fills [height][width][4] floats, all of them. They are borrowed
 * until the next begin or release and hold arbitrary numbers at first. */
float *tl_linear_image_begin_cpu(struct tl_linear_image *image, int width, int height);
/* Begins an image on the GPU: the caller draws over all of the target, which is bound, with its viewport. */
void tl_linear_image_begin_gpu(struct tl_linear_image *image, tl_gpu *gpu, int width, int height);

/* The image as a texture, sent to the GPU if it is not there yet; valid until the next begin. */
const tl_texture *tl_linear_image_texture(struct tl_linear_image *image, tl_gpu *gpu);
/* Copies the image, rows downwards: F32 RGBA. The caller releases `out` with tl_image_release. */
void tl_linear_image_read(const struct tl_linear_image *image, tl_image *out);

void tl_linear_image_release(struct tl_linear_image *image);
size_t tl_linear_image_bytes(const struct tl_linear_image *image);

#endif
