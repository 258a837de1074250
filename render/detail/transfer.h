/* Normals and heights of a finer mesh as maps of a coarser one of the same garment [Heidrich and Seidel 1999,
 * 5]. From each texel's point of the coarse mesh a ray goes along the interpolated normal, both ways;
 * the nearer hit that faces the same way gives the finer normal, in the coarse tangent space, and the height.
 *
 * The UVs of the coarse mesh must lie in the unit square. A texel that lies in several of its triangles
 * belongs to the first of them. Texels beside the charts, and those whose ray hits nothing within reach, take
 * the mean of their neighbours, TL_TRANSFER_MARGIN texels far, so that filtering at a chart's border reads
 * what is there; farther away they are flat.
 *
 * Errors: TL_INPUT when UVs are missing or leave the unit square, when nothing is hit, when memory is
 * refused; TL_DEVICE of Embree. Threads: OpenMP inside; the result is the same at any number of threads. */
#ifndef TOILE_RENDER_DETAIL_TRANSFER_H
#define TOILE_RENDER_DETAIL_TRANSFER_H

#include "assets/base/surface.h"
#include "config/base/error.h"

#define TL_TRANSFER_MARGIN   8
#define TL_TRANSFER_SIDE_MAX 8192

struct tl_transfer_params {
    int width, height; /* texels, 1 to TL_TRANSFER_SIDE_MAX */
    float reach_m;     /* of rays, to either side */
};

struct tl_transfer {
    tl_image normals; /* F32 x3: unit, in tangent space, +Y up */
    tl_image heights; /* F32 x1: metres along the coarse normal */
    size_t covered;   /* texels in a triangle */
    size_t shared;    /* ... in several */
    size_t missed;    /* ... whose ray hit nothing */
};

/* Transfers from `fine` to `coarse`, which has tangents. Release the result; it is empty after a failure. */
bool tl_transfer_make(const tl_surface *coarse, const tl_surface *fine,
                      const struct tl_transfer_params *params, struct tl_transfer *out, tl_error *error);
void tl_transfer_release(struct tl_transfer *transfer); /* frees and zeroes */

#endif
