/* Reads heights from a picture: as values, and as the repeat of a fabric in place of generated yarns. */
#ifndef TOILE_APP_TEXTURES_HEIGHT_PICTURE_H
#define TOILE_APP_TEXTURES_HEIGHT_PICTURE_H

#include "assets/weave/weave.h"
#include "config/base/error.h"

/* Loads the first channel: an EXR's values as they are, a PNG's from 0 to 1. Refuses values that are not
 * finite. */
bool tl_height_picture_load(const char *path, tl_image *out, tl_error *error);

/* Makes the weave of `params->picture`, which must not be empty: its lowest value lies half of `depth_mm`
 * under the fabric's middle, its highest as much over it. */
bool tl_height_picture_weave(const struct tl_weave_params *params, tl_weave *out, tl_error *error);

/* Loads heights in metres, an .exr, as a height map of a material has them: F32 x1, 0 the lowest and 1 the
 * highest, which are limits_m[0] and [1] above the mesh. */
bool tl_height_picture_metres(const char *path, tl_image *out, float limits_m[2], tl_error *error);

/* Loads a normal map: U8 x3. Refuses pictures without colours. */
bool tl_normal_picture_load(const char *path, tl_image *out, tl_error *error);

#endif
