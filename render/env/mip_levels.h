/* Mip levels of a picture of the sphere, weighted by solid angle [Heidrich and Seidel 1999, 4.2]: a texel is
 * the mean of four texels of the finer level, weighted by the solid angles that they cover. So every level
 * holds the same light as the first, in any layout. Pure; results do not depend on the number of threads.
 *
 * Pictures here are RGBA, float. Alpha is 1 where the first disc of a dual paraboloid is to be read (op.
 * cit., 4.1) and 0 elsewhere. */
#ifndef TOILE_RENDER_ENV_MIP_LEVELS_H
#define TOILE_RENDER_ENV_MIP_LEVELS_H

#include "render/env/layout.h"

#define TL_MIP_LEVELS_MAX 14

struct tl_mip_levels {
    struct tl_sphere_map maps[TL_MIP_LEVELS_MAX]; /* the first is the picture itself */
    double *solid_angles[TL_MIP_LEVELS_MAX];      /* [height][width] of each, sr */
    int count;
};

/* Extents and solid angles of all levels of a picture; no texels. `size` is a power of two, at most 2^13. In
 * the last level discs, faces or rows have one texel. Released by tl_mip_levels_release. */
struct tl_mip_levels tl_mip_levels_create(enum tl_layout layout, int size);
void tl_mip_levels_release(struct tl_mip_levels *levels);

/* Computes level `level`, [height][width][4], from level - 1. Texels of the coarser level that lie off the
 * sphere get the colour of the nearest texels on it. */
void tl_mip_levels_reduce(const struct tl_mip_levels *levels, int level, const float *finer, float *coarser);

/* True where a bilinear fetch at the centre of the texel reads texels inside the first disc only. Always true
 * in layouts without discs. */
bool tl_mip_levels_reads_first(const struct tl_sphere_map *map, int x, int y);

#endif
