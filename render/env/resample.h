/* Lat-long images resampled to cubes by area averages. The overlaps of the texels depend on the sizes only,
 * so a sequence of images reuses the weights of its first. Pure; results depend neither on the number of
 * threads nor on whether weights were reused. */
#ifndef TOILE_RENDER_ENV_RESAMPLE_H
#define TOILE_RENDER_ENV_RESAMPLE_H

#include "assets/base/image.h"

/* The overlap of a source texel and a cube texel. */
struct tl_resampling_share {
    uint32_t source;   /* y * width + x */
    float solid_angle; /* sr, of the overlap */
};

/* The overlaps of all texels; owns its arrays. About 12 bytes per source texel. */
struct tl_resampling {
    int width, height; /* of the image; 0: empty */
    int size;          /* of the cube */
    uint32_t *first;   /* [6 * size * size + 1]: index of the first share of each cube texel */
    struct tl_resampling_share *shares;
};

/* Computes the area average over every cube texel, into `texels` [6][size][size][3]. Reuses `weights` if they
 * belong to these sizes and replaces them otherwise. Large images are processed in bands, and `weights` is
 * left as it is. */
void tl_resample_latlong(const tl_image *image, int size, float *texels, struct tl_resampling *weights);
/* Frees and zeroes. */
void tl_resampling_release(struct tl_resampling *weights);

#endif
