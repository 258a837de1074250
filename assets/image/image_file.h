/* PNG, JPEG and TIFF files as images, and images as PNG. Threads: pure, but for reading and writing files. */
#ifndef TOILE_ASSETS_IMAGE_IMAGE_FILE_H
#define TOILE_ASSETS_IMAGE_IMAGE_FILE_H

#include "assets/base/image.h"

/* Decodes PNG (also 16-bit, indexed, interlaced), JPEG and TIFF from memory, and from a file, into U8. `name`
 * is for messages. *out belongs to the caller; zeroed on failure. */
bool tl_image_decode(const char *name, const void *data, size_t size, tl_image *out, tl_error *error);
bool tl_image_load(const char *path, tl_image *out, tl_error *error);

/* Decodes the first channel as data, 0 to 1, F32 x1, with the full precision of 16 bits and of a TIFF's
 * floats, which may leave that range. */
bool tl_image_decode_values(const char *name, const void *data, size_t size, tl_image *out, tl_error *error);
bool tl_image_load_values(const char *path, tl_image *out, tl_error *error);

/* Encodes a U8 image as PNG in memory; free(*data). `name` is for messages. */
bool tl_image_encode_png(const char *name, const tl_image *image, void **data, size_t *size, tl_error *error);
/* Writes a U8 image as a PNG file, which appears whole or not at all. */
bool tl_image_save_png(const char *path, const tl_image *image, tl_error *error);

#endif
