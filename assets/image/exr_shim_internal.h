/* The pixels of OpenEXR parts that OpenEXRCore 3.1 cannot decode (DWAA, DWAB, B44, B44A), through OpenEXR's
 * C++ library. Private to assets/image/exr.c, which has checked the header before. Exceptions stop here. */
#ifndef TOILE_ASSETS_IMAGE_EXR_SHIM_INTERNAL_H
#define TOILE_ASSETS_IMAGE_EXR_SHIM_INTERNAL_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

struct tl_exr_plane {
    const char *channel;
    int x_sampling, y_sampling;
    float *values; /* of the data window's first sample */
    size_t step;   /* floats from one sample to the next */
    size_t width;  /* samples a row */
};

/* Reads whole channels of one flat part of a file in memory; on failure says why in `complaint`. */
bool tl_exr_shim_read(const void *data, size_t size, int part, const struct tl_exr_plane *planes,
                      size_t plane_count, char *complaint, size_t complaint_size);

#ifdef __cplusplus
}
#endif

#endif
