/* PEMs as cropped parts of paraboloid maps [Knuth et al. 2014, 5].
 *
 * There are six charts, a paraboloid about each of the axes +X -X +Y -Y +Z -Z. A unit direction d lies in the
 * chart of its largest component m, at p = (the other two in order) / (1 + |m|): |p| = tan(a / 2) at the
 * angle a from the axis, and at most tan(22.5 degrees) along the chart's own axes. Level l of a cube of
 * `size` texels a face is sampled on a lattice of tl_paraboloid_density(size, l) texels a unit of p; texel i
 * is centred at (i + 0.5) / density on either axis. The lattice goes on to the first centres beyond the
 * chart, so that fetches at its border are bilinear, too.
 *
 * All regions share the charts, and each keeps the boxes of texels that its light reaches in them, as the
 * filters have spread it: most fine levels lie in one chart, those of the widest lobes in all. So the maps of
 * all regions add up to the map of the whole environment, texel by texel, and a constant stays constant. With
 * charts about the centre of each region a constant was off at level 0 by 1.6 % root mean square and by up to
 * 29 %, at level 1 by 0.4 and 4 %, in lines along all borders of regions; with charts about +Z and -Z
 * alone 2.1 times the memory was taken. Pure; threads: any. */
#ifndef TOILE_RENDER_PEM_PARABOLOIDS_H
#define TOILE_RENDER_PEM_PARABOLOIDS_H

#include "render/pem/chain.h"

#define TL_PARABOLOID_CHARTS     6
#define TL_PARABOLOID_LEVELS_MAX 10 /* of cubes of 512 texels */

/* Part of a lattice. The light ends within its outermost texels, unless these are the lattice's. Width 0:
 * nothing of the chart is lit. */
struct tl_paraboloid_crop {
    int x0, y0, width, height; /* first texel of the lattice; texels */
    int atlas_x, atlas_y;      /* first texel in the texture that holds it; set by tl_paraboloids_pack */
};

/* The maps of one region. */
struct tl_paraboloid {
    int level_count;
    struct tl_paraboloid_crop crops[TL_PARABOLOID_LEVELS_MAX][TL_PARABOLOID_CHARTS];
};

/* Texels a unit of p. */
int tl_paraboloid_density(int size, int level);

/* The crops of a region whose filtered levels are `chain`. */
struct tl_paraboloid tl_paraboloid_place(const struct tl_chain *chain);
/* Samples a level of the chain: [height][width][3] of its crop, owned by the caller; NULL where it is black.
 */
float *tl_paraboloid_sample(const struct tl_paraboloid *map, const struct tl_chain *chain, int level,
                            int chart);

/* Chart and point of a unit direction. */
int tl_paraboloid_project(vec3s direction, float p[2]);
/* Bilinear fetch at p from the texels of a crop, black outside of it. */
vec3s tl_paraboloid_fetch(const struct tl_paraboloid_crop *crop, int density, const float *texels,
                          const float p[2]);
/* Fetches those texels of a cube, at their centres, that lie in the chart. */
void tl_paraboloid_resample(const struct tl_paraboloid_crop *crop, int density, const float *texels,
                            int chart, const tl_cube *out);

/* Places the crops of some maps side by side in one texture of width x height texels, at least 1 x 1. */
void tl_paraboloids_pack(struct tl_paraboloid *maps, int count, int *width, int *height);

#endif
