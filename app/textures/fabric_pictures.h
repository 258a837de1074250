/* The pictures of a fabric, weave.pictures, as a weave that tiles over the cloth, and as the maps that a
 * weave has not.
 *
 * Errors: those of tl_fabric_file_open and tl_fabric_maps_load; `out` is then empty. Threads: pure, but for
 * reading the files. */
#ifndef TOILE_APP_TEXTURES_FABRIC_PICTURES_H
#define TOILE_APP_TEXTURES_FABRIC_PICTURES_H

#include "assets/weave/weave.h"

struct tl_fabric_pictures {
    tl_weave weave;
    tl_image cover;    /* U8 x4, white: alpha is how much of the surface is there; empty: all */
    tl_image specular; /* U8 x3, sRGB: multiplies specular; empty: 1 */
};

/* Lifetime: the caller releases `out`. */
bool tl_fabric_pictures_make(const struct tl_weave_params *params, struct tl_fabric_pictures *out,
                             tl_error *error);
void tl_fabric_pictures_release(struct tl_fabric_pictures *pictures); /* frees and zeroes */

/* The transform that lays a repeat to scale on a part whose UV unit is `uv_metres` long. */
struct tl_uv_transform tl_fabric_pictures_transform(const tl_weave *weave, float uv_metres);

#endif
