/* OpenEXR files, through OpenEXR's C++ library (assets/image/exr_shim.cpp).
 *
 * Read: scan lines and tiles, half, float and uint, every compression that the library has, any data window,
 * channels R G B [A], Y [A], luminance-chroma Y RY BY, else the first layer with R, G and B, and one-channel
 * files; of a multi-part file the first part that has such colours and is not deep. Values are returned as
 * they are in the file, NaN and infinities included. A file of deep data only is refused. Written: scan lines
 * of floats, ZIP.
 *
 * Errors: false with one message (TL_INPUT, TL_OUTPUT); sizes are checked against the file's length before
 * memory is allocated. Lifetime: images that are read belong to the caller, tl_image_release; nothing is kept
 * of what is written. Threads: several, each with a file of its own; no thread is started. */
#ifndef TOILE_ASSETS_IMAGE_EXR_H
#define TOILE_ASSETS_IMAGE_EXR_H

#include "assets/base/image.h"

/* The file's envmap attribute. The last three are not of OpenEXR: the file's comments begin with
 * TL_EXR_ENVMAP_COMMENT and "sphere", "dual paraboloid" or "octahedral", as `toile env` writes them. */
enum tl_exr_envmap {
    TL_EXR_NOT_ENVMAP,
    TL_EXR_LATLONG,
    TL_EXR_CUBE,
    TL_EXR_SPHERE,
    TL_EXR_PARABOLOID,
    TL_EXR_OCTAHEDRAL
};
#define TL_EXR_ENVMAP_COMMENT "environment map, "

/* Reads a file into *out: F32, 3 channels (RGB), or 4 when the file has alpha. The data window becomes the
 * image; the display window is ignored. *out is zeroed on failure. */
bool tl_exr_load(const char *path, tl_image *out, enum tl_exr_envmap *envmap, tl_error *error);

/* Reads one channel by its full name, such as "garment.Y", into *out: F32, 1 channel. True with *out empty
 * when the file has no such channel. *out is zeroed on failure. */
bool tl_exr_load_channel(const char *path, const char *channel, tl_image *out, tl_error *error);

/* A layer of a file to be written. */
struct tl_exr_layer {
    const char *const *channel_names; /* [image->channels], such as "R", "G", "B" or "normal.X" ... */
    const tl_image *image;            /* F32; all layers have the same size */
};

/* Writes at least one layer. The file appears whole or not at all. */
bool tl_exr_save(const char *path, const struct tl_exr_layer *layers, size_t layer_count, tl_error *error);

/* Is tl_exr_save with the attribute "comments", which image viewers show; NULL: without. */
bool tl_exr_save_commented(const char *path, const struct tl_exr_layer *layers, size_t layer_count,
                           const char *comments, tl_error *error);

#endif
