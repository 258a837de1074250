/* Environments by file (here) and built in (assets/environment/studio.h). */
#ifndef TOILE_ASSETS_ENVIRONMENT_ENVIRONMENT_H
#define TOILE_ASSETS_ENVIRONMENT_ENVIRONMENT_H

#include "assets/base/environment.h"
#include "assets/environment/studio.h"
#include "config/base/error.h"

/* Loads an OpenEXR or Radiance picture, recognised by its content. An EXR is a cube map when its envmap
 * attribute states so or its sides are 1:6 or 6:1, what its comments state when `toile env` wrote it;
 * everything else is lat-long. Negative values, NaN and infinities are replaced as base/environment.h states,
 * and counted. `shown` is what assets/environment/adaptation.h makes of it.
 *
 * Errors: false, *out zeroed, with one message (TL_INPUT) for a file that is missing, cut short or damaged,
 * larger than TL_LIMIT_IMAGE_*, or of another shape than the layout that it states.
 * Lifetime: *out owns its image; tl_environment_release. The file is closed on return.
 * Threads: several threads may load at once. */
bool tl_environment_load(const char *path, tl_environment *out, tl_error *error);

/* The same of a picture in memory, F32, which it takes, also on failure. */
bool tl_environment_take(const char *path, tl_image *image, tl_environment *out, tl_error *error);

/* Computes `shown` and `ground` of a lat-long or cube map; leaves other layouts as they are. */
void tl_environment_adapt(tl_environment *environment);

#endif
