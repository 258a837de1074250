/* Radiance pictures (.hdr, .pic): RGBE, run-length encoded or flat, any order of the axes that starts with Y.
 * Reference: G. Ward, "Real Pixels", Graphics Gems II, and the file format
 * page of the Radiance manual. */
#ifndef TOILE_ASSETS_IMAGE_RADIANCE_H
#define TOILE_ASSETS_IMAGE_RADIANCE_H

#include "assets/base/image.h"

/* Decodes into *out: F32, RGB, the stored radiance divided by the header's EXPOSUREs. `name` is for messages.
 *
 * Errors: false with one message (TL_INPUT). Lifetime: *out is the caller's. Threads: any. */
bool tl_radiance_decode(const char *name, const void *data, size_t size, tl_image *out, tl_error *error);

/* Whether the bytes start like a Radiance picture. */
bool tl_radiance_begins(const void *data, size_t size);

#endif
