/* TIFF images in memory, through libtiff: strips and tiles, 8 and 16 bits and 32-bit floats, every
 * compression that the library has. The first image of a file.
 *
 * Errors: false with one line (TL_INPUT); sizes are checked against the file's length before memory is
 * allocated. Lifetime: images belong to the caller; `data` is borrowed during the call. Threads: several,
 * each with data of its own. */
#ifndef TOILE_ASSETS_IMAGE_TIFF_INTERNAL_H
#define TOILE_ASSETS_IMAGE_TIFF_INTERNAL_H

#include "assets/base/image.h"

#include <stddef.h>

/* Whether the data begin as a TIFF file of either byte order does. */
bool tl_tiff_is(const void *data, size_t size);

/* Decodes into U8: 3 channels, or 4 when the file has alpha, which is not multiplied into the colour. */
bool tl_tiff_decode(const char *name, const void *data, size_t size, tl_image *out, tl_error *error);

/* Decodes the first channel as data: F32 x1, whole numbers scaled to [0, 1], floats as they are. */
bool tl_tiff_decode_values(const char *name, const void *data, size_t size, tl_image *out, tl_error *error);

#endif
