/* The fine levels of PEMs as paraboloid maps, cropped to what is not black [002, section 6].
 *
 * A unit direction d lies at p = (d.right, d.up) / (1 + d.direction) of a frame: p is tan(a / 2) long at the
 * angle a from the frame's direction. Level l of a cube of `size` texels a face is sampled on a lattice of
 * TL_PARABOLOID_DENSITY x (size >> l) texels a unit of p, at its centre that many times as dense as the
 * centre of a face. Texel i of the lattice is centred at (i + 0.5) / density on either axis.
 *
 * Maps of the regions of one face have one frame, the face's. Their texels coincide, so that the maps of
 * neighbours add up to the map of both: with a frame for each region a constant environment is off by twice
 * as much, in lines along all borders of regions instead of the edges of the cube. Regions of a cut of the
 * sphere have frames of their own.
 *
 * The filtered region is wider than the region by the reach of the filter. A level is stored as paraboloids
 * while these take fewer texels than cubes; coarser levels, whose lobes are about as wide as half the sphere,
 * stay cubes. Pure; threads: any. */
#ifndef TOILE_RENDER_PEM_PARABOLOIDS_H
#define TOILE_RENDER_PEM_PARABOLOIDS_H

#include "render/pem/chain.h"
#include "render/pem/regions.h"

#define TL_PARABOLOID_LEVELS_MAX 7
#define TL_PARABOLOID_DENSITY    2

/* Part of a lattice; its outermost texels are black. Width 0: the level is black. */
struct tl_paraboloid_crop {
    int x0, y0, width, height; /* first texel of the lattice; texels */
    int atlas_x, atlas_y;      /* first texel in the texture that holds it; set by tl_paraboloids_pack */
};

/* The maps of one region. */
struct tl_paraboloid {
    vec3s right, up, direction; /* environment's frame, unit */
    struct tl_paraboloid_crop crops[TL_PARABOLOID_LEVELS_MAX];
};

/* Texels a unit of p. */
float tl_paraboloid_density(int size, int level);

/* The number of levels that are stored as paraboloids, estimated from the lit texels of all regions and the
 * reach of the filters; 0 to TL_PARABOLOID_LEVELS_MAX, and fewer than the chain has. */
int tl_paraboloid_levels(const tl_cube *cube, const struct tl_regions *regions);

/* Frame and crops of a region whose filtered levels are `chain`. */
struct tl_paraboloid tl_paraboloid_place(const struct tl_region *region, const struct tl_chain *chain,
                                         int levels);
/* Samples a level of the chain: [height][width][3] of its crop, owned by the caller; NULL where it is black.
 */
float *tl_paraboloid_sample(const struct tl_paraboloid *map, const struct tl_chain *chain, int level);
/* Bilinear fetch from such texels, black outside of the crop. */
vec3s tl_paraboloid_fetch(const struct tl_paraboloid *map, int level, float density, const float *texels,
                          vec3s direction);

/* Places the crops of some maps side by side in one texture of width x height texels, at least 1 x 1. */
void tl_paraboloids_pack(struct tl_paraboloid *maps, int count, int levels, int *width, int *height);

#endif
