/* OpenEXR's C++ library as plain C: a file's parts, their pixels, and files written. Exceptions stop here.
 *
 * The library trusts a header's sizes, so tl_exr_load checks the bytes before they come here.
 * Errors: false or NULL, with the library's reason in `complaint` (one line, of TL_EXR_COMPLAINT bytes).
 * Threads: several, each with its own file; the library starts no threads of its own. */
#ifndef TOILE_ASSETS_IMAGE_EXR_SHIM_INTERNAL_H
#define TOILE_ASSETS_IMAGE_EXR_SHIM_INTERNAL_H

#include "assets/image/exr.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum { TL_EXR_COMPLAINT = 256 };

struct tl_exr_channel {
    const char *name;
    int x_sampling, y_sampling; /* a sample every so many columns and rows */
};

/* A part with flat (not deep) pixels. */
struct tl_exr_part {
    int index; /* in the file */
    bool is_tiled;
    int min_x, min_y, max_x, max_y; /* the data window; both ends belong to it */
    enum tl_exr_envmap envmap;
    uint64_t texel_bytes;        /* of all channels together */
    int tile_width, tile_height; /* texels; 0 when it is not tiled */
    size_t channel_count;
    const struct tl_exr_channel *channels; /* by name; lives as long as the file */
};

/* The destination of one channel's samples. */
struct tl_exr_plane {
    const char *channel;
    int x_sampling, y_sampling;
    float *values; /* of the data window's first sample */
    size_t step;   /* floats from one sample to the next */
    size_t width;  /* samples in a row */
};

typedef struct tl_exr_file tl_exr_file; /* an open file and its first flat part */

/* Reads the headers of a file in memory. *part is filled when there is a flat part; else its index is -1.
 * `data` must outlive the file. `path` is for messages. */
tl_exr_file *tl_exr_shim_open(const char *path, const void *data, size_t size, struct tl_exr_part *part,
                              char *complaint);
void tl_exr_shim_close(tl_exr_file *file);

/* Decodes whole channels of the part that tl_exr_shim_open found, as floats. */
bool tl_exr_shim_read(tl_exr_file *file, const struct tl_exr_plane *planes, size_t plane_count,
                      char *complaint);

/* Writes a scan-line file of float channels, ZIP. `comments`: the attribute of that name, or NULL. */
bool tl_exr_shim_write(FILE *stream, const struct tl_exr_layer *layers, size_t layer_count,
                       const char *comments, char *complaint);

#endif
