/* Heights that a picture holds: as they are, and as a fabric's repeat in place of drawn yarns. */
#ifndef TOILE_APP_SCENE_HEIGHT_PICTURE_H
#define TOILE_APP_SCENE_HEIGHT_PICTURE_H

#include "assets/builtin/weave.h"
#include "config/error.h"

/* Values of the first channel: an EXR's own, a PNG's from 0 to 1. Refuses what is not finite. */
bool tl_height_picture_load(const char *path, tl_image *out, tl_error *error);

/* `params->picture` is not empty: its lowest value lies half of `depth_mm` under the fabric's middle, its
 * highest as much over it. */
bool tl_height_picture_weave(const struct tl_weave_params *params, tl_weave *out, tl_error *error);

#endif
