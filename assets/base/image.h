/* Images in memory.
 *
 * Rows run from the top of the picture down, texels within a row from left to right, channels interleaved.
 * TL_IMAGE_U8 holds file values: colour images are sRGB-encoded unless `linear` is set. TL_IMAGE_F32 is
 * linear. Ownership: tl_image owns `texels`; tl_image_release frees. Threads: pure. */
#ifndef TOILE_ASSETS_BASE_IMAGE_H
#define TOILE_ASSETS_BASE_IMAGE_H

#include "config/base/error.h"

#include <stddef.h>
#include <stdint.h>

#define TL_LIMIT_IMAGE_SIDE   32768             /* texels */
#define TL_LIMIT_IMAGE_TEXELS ((size_t)1 << 28) /* 16384 x 16384 */

enum tl_image_type { TL_IMAGE_U8, TL_IMAGE_F32 };

typedef struct tl_image {
    int width, height; /* texels */
    int channels;      /* 1 to 4 */
    enum tl_image_type type;
    bool linear;  /* U8 only: values are data (normals, gloss), not sRGB colour */
    void *texels; /* uint8_t or float, [height][width][channels] */
} tl_image;

/* Zeroed image; sizes are asserted to be within the limits, so check file sizes with tl_image_size_check
 * first. */
tl_image tl_image_create(int width, int height, int channels, enum tl_image_type type);
void tl_image_release(tl_image *image); /* frees and zeroes; a zeroed image is accepted */
/* False, with a message that names `name`, for a size that is not positive or beyond the limits. */
bool tl_image_size_check(const char *name, int64_t width, int64_t height, tl_error *error);

/* The texels of an F32 and of a U8 image; owned by the image. */
static inline float *tl_image_floats(const tl_image *image)
{
    return (float *)image->texels;
}
static inline uint8_t *tl_image_bytes(const tl_image *image)
{
    return (uint8_t *)image->texels;
}

#endif
