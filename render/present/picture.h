/* The picture for a screen: RGBA8, sRGB-encoded, rows upwards as GL has them. It is made on the CPU or on the
 * GPU and kept, so that a window whose image has not changed is only copied to. Threads: that of the tl_gpu's
 * context. */
#ifndef TOILE_RENDER_PRESENT_PICTURE_H
#define TOILE_RENDER_PRESENT_PICTURE_H

#include "render/gpu/gpu.h"

struct tl_picture {
    int width, height;            /* pixels; 0 before the first picture */
    int first_column, end_column; /* the columns [first, end) that hold the picture */
    uint8_t *bytes;               /* [height][width][4]; NULL: the picture is on the GPU alone */
    size_t byte_count;            /* of these */
    tl_target target;             /* as large as the picture; id 0: the picture is on the CPU alone */
    bool is_sent;                 /* the target holds the picture */
};

/* The part of a picture that is drawn: pixels, columns [first, end). */
struct tl_picture_part {
    int width, height;
    int first_column, end_column;
};
bool tl_picture_has(const struct tl_picture *picture, const struct tl_picture_part *part);

/* Begins a picture on the CPU: the caller writes the part's columns of [height][width][4] bytes, which are
 * borrowed until the next begin or release. */
uint8_t *tl_picture_begin_cpu(struct tl_picture *picture, const struct tl_picture_part *part);
/* Begins a picture on the GPU: the caller draws the part's columns of the target, which is bound, with its
 * viewport. */
void tl_picture_begin_gpu(struct tl_picture *picture, tl_gpu *gpu, const struct tl_picture_part *part);

/* Copies columns [first, end) to a framebuffer (GL name) that has as many pixels, and leaves it bound: a
 * window's panel is drawn over them. */
void tl_picture_copy(struct tl_picture *picture, tl_gpu *gpu, unsigned framebuffer, int first_column,
                     int end_column);
/* Copies the picture, rows downwards: U8 RGB. The caller releases `out` with tl_image_release. */
void tl_picture_read(const struct tl_picture *picture, tl_image *out);

void tl_picture_release(struct tl_picture *picture);
size_t tl_picture_bytes(const struct tl_picture *picture);

#endif
