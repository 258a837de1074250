/* Pictures in memory, and PNG/JPEG files.
 *
 * Rows run from the top of the picture down, texels within a row from left to right, channels interleaved.
 * TL_IMAGE_U8 holds file values: colour images are sRGB-encoded unless `linear` is set. TL_IMAGE_F32 is
 * linear. Ownership: tl_image owns `texels`; tl_image_release frees. Threads: pure, but for the file
 * functions. */
#ifndef TOILE_ASSETS_BASE_IMAGE_H
#define TOILE_ASSETS_BASE_IMAGE_H

#include "config/error.h"

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
void tl_image_release(tl_image *image); /* frees and zeroes; a zeroed image is fine */
bool tl_image_size_check(const char *name, int64_t width, int64_t height, tl_error *error);

static inline float *tl_image_floats(const tl_image *image)
{
    return (float *)image->texels;
}
static inline uint8_t *tl_image_bytes(const tl_image *image)
{
    return (uint8_t *)image->texels;
}

/* PNG (also 16-bit, indexed, interlaced) and JPEG from memory into U8; `name` is for messages. */
bool tl_image_decode(const char *name, const void *data, size_t size, tl_image *out, tl_error *error);
bool tl_image_load(const char *path, tl_image *out, tl_error *error);

/* The first channel of a PNG or JPEG as data, 0 to 1, F32 x1: what 16 bits hold is kept. */
bool tl_image_load_values(const char *path, tl_image *out, tl_error *error);

/* U8 image as PNG in memory; free(*data). `name` is for messages. */
bool tl_image_encode_png(const char *name, const tl_image *image, void **data, size_t *size, tl_error *error);
/* ... and as a file; atomic. */
bool tl_image_save_png(const char *path, const tl_image *image, tl_error *error);

/* sRGB transfer function, IEC 61966-2-1. */
float tl_srgb_to_linear(float encoded);
float tl_srgb_from_linear(float linear);

#endif
