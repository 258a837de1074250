/* Maps of a material on the CPU: mip levels by exact area averages in linear float, as GL is given them too,
 * and trilinear fetches at the level that GL defines [OpenGL 4.5, 8.14]. Borrows the image. Threads: pure
 * once made. */
#ifndef TOILE_RENDER_GPU_MAP_TEXTURE_H
#define TOILE_RENDER_GPU_MAP_TEXTURE_H

#include "assets/base/image.h"

#include <cglm/struct.h>

#define TL_TEXTURE_LEVELS_MAX 16

struct tl_map_texture {
    const tl_image *image; /* level 0 */
    bool colour;           /* sRGB unless the image is marked linear; one channel is a grey */
    float decode[256];     /* linear values of bytes */
    int level_count;
    int widths[TL_TEXTURE_LEVELS_MAX], heights[TL_TEXTURE_LEVELS_MAX];
    float *levels[TL_TEXTURE_LEVELS_MAX]; /* [height][width][channels], from level 1 on */
};

struct tl_map_texture tl_map_texture_make(const tl_image *image, bool colour);
void tl_map_texture_release(struct tl_map_texture *texture);

/* The place of a look-up, and its difference to the neighbouring samples' across and down. */
struct tl_footprint {
    vec2s uv, across, down;
};

/* Missing channels are 0, alpha 1. */
vec4s tl_map_texture_fetch(const struct tl_map_texture *texture, const struct tl_footprint *at, bool clamp_u,
                           bool clamp_v);

#endif
