/* Mip levels of a picture of the sphere, weighted by solid angle (Heidrich and Seidel 1999, 4.2): a texel is
 * the mean of the four that it stands for, each weighed by the solid angle that it covers of the sphere, and
 * covers their sum in turn. So every level holds the same light as the first, in any layout. Pure; results do
 * not depend on the number of threads.
 *
 * Pictures here are RGBA, float; alpha is not the sphere's: it is 1 where a dual paraboloid's first disc is
 * to be read (op. cit., 4.1) and 0 elsewhere. */
#ifndef TOILE_RENDER_ENV_MIP_LEVELS_H
#define TOILE_RENDER_ENV_MIP_LEVELS_H

#include "render/env/layout.h"

#define TL_MIP_LEVELS_MAX 14

struct tl_mip_levels {
    struct tl_sphere_map maps[TL_MIP_LEVELS_MAX]; /* the first is the picture itself */
    double *solid_angles[TL_MIP_LEVELS_MAX];      /* [height][width] of each, sr */
    int count;
};

/* `size` is a power of two, at most 2^13. The last level's discs, faces or rows have one texel. */
struct tl_mip_levels tl_mip_levels_create(enum tl_layout layout, int size);
void tl_mip_levels_release(struct tl_mip_levels *levels);

/* Fills level - 1 -> level: [height][width][4]. Texels of the coarser level that lie off the sphere show what
 * a look-up beside them would find on it. */
void tl_mip_levels_reduce(const struct tl_mip_levels *levels, int level, const float *finer, float *coarser);

/* Whether the centre of a texel of this picture lies so far inside of the first disc that the four texels of
 * a bilinear fetch there do, too; always true where there are no discs. */
bool tl_mip_levels_reads_first(const struct tl_sphere_map *map, int x, int y);

#endif
