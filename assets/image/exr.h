/* OpenEXR files through OpenEXR's C API (OpenEXRCore).
 *
 * Read: scan lines and tiles, half, float and uint, every compression the library has, any data window,
 * channels R G B [A], Y [A], luminance-chroma Y RY BY, and one-channel files; the first non-deep part of a
 * multi-part file. Values are returned as they are in the file, NaN and infinities included; what to do with
 * them is the caller's decision. Deep data is refused with a message. Written: scan-line float, ZIP, atomic.
 */
#ifndef TOILE_ASSETS_IMAGE_EXR_H
#define TOILE_ASSETS_IMAGE_EXR_H

#include "assets/base/image.h"

enum tl_exr_envmap { TL_EXR_NOT_ENVMAP, TL_EXR_LATLONG, TL_EXR_CUBE }; /* the file's envmap attribute */

/* *out: F32, 3 channels (RGB) or 4 when the file has alpha. The data window becomes the image. */
bool tl_exr_load(const char *path, tl_image *out, enum tl_exr_envmap *envmap, tl_error *error);

/* One layer of a written file: "" gives R G B [A]; "normal" gives normal.X ... or what `channel_names` says.
 */
struct tl_exr_layer {
    const char *const
        *channel_names;    /* as many as image->channels, e.g. "R", "G", "B", "A" or "normal.X" ... */
    const tl_image *image; /* F32; all layers have the same size */
};
bool tl_exr_save(const char *path, const struct tl_exr_layer *layers, size_t layer_count, tl_error *error);
/* The same with the attribute "comments", which viewers show. */
bool tl_exr_save_commented(const char *path, const struct tl_exr_layer *layers, size_t layer_count,
                           const char *comments, tl_error *error);

#endif
