/* Lat-long images poured into cubes: how the texels of the one share out over those of the other. That
 * depends on their sizes only, so that a sequence of images is poured with the shares of its first. Pure;
 * results do not depend on the number of threads, nor on whether shares were kept. */
#ifndef TOILE_RENDER_ENV_RESAMPLE_H
#define TOILE_RENDER_ENV_RESAMPLE_H

#include "assets/base/image.h"

/* What a source texel gives to a cube texel. */
struct tl_resampling_share {
    uint32_t source;   /* y * width + x */
    float solid_angle; /* sr, of what they have in common */
};

/* Owns its arrays. About 12 bytes a source texel. */
struct tl_resampling {
    int width, height; /* of the image; 0: nothing is kept */
    int size;          /* of the cube */
    uint32_t *first;   /* [6 * size * size + 1]: where the shares of each cube texel begin */
    struct tl_resampling_share *shares;
};

/* Area average over every cube texel, into `texels` [6][size][size][3]. Uses the shares in `kept` when they
 * are those of these sizes, and else replaces them; large images are poured in bands, and nothing is kept. */
void tl_resample_latlong(const tl_image *image, int size, float *texels, struct tl_resampling *kept);
void tl_resampling_release(struct tl_resampling *pour);

#endif
