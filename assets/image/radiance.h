/* Radiance pictures (.hdr, .pic): RGBE, run-length encoded or flat, any order of the axes that starts with Y.
 * Private to assets/environment.c. Reference: G. Ward, "Real Pixels", Graphics Gems II, and the file format
 * page of the Radiance manual. */
#ifndef TOILE_ASSETS_IMAGE_RADIANCE_H
#define TOILE_ASSETS_IMAGE_RADIANCE_H

#include "assets/base/image.h"

/* *out: F32, RGB, radiance as stored divided by the header's EXPOSUREs. `name` is for messages. */
bool tl_radiance_decode(const char *name, const void *data, size_t size, tl_image *out, tl_error *error);

/* True when the bytes begin as a Radiance picture does. */
bool tl_radiance_begins(const void *data, size_t size);

#endif
