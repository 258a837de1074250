/* A repeating height field on which strands are laid: the loops of a knit, the fibres of a nap. Every point
 * keeps the highest strand, and how much of the cloth's colour that one shows. From the heights follow
 * normals and how dark valleys are. Metres; rows run down, y runs up. Deterministic at any number of threads.
 */
#ifndef TOILE_ASSETS_WEAVE_TILE_H
#define TOILE_ASSETS_WEAVE_TILE_H

#include "assets/base/material.h"

#include <stdint.h>

#define TL_TILE_SIDE_MIN 32 /* texels: what valleys see of the sky is looked for within fewer */
#define TL_TILE_SIDE_MAX 2048

struct tl_tile {
    int width, height; /* texels */
    double size_m[2];
    float *heights;
    float *tints; /* RGB: factor on the colour */
    float *leans; /* slopes along x and y that a pile's axis has beyond the heights'; NULL: none. Owned */
};

/* Flat, at `base_m`, of sides within the bounds above. The caller releases it. */
struct tl_tile tl_tile_make(int width, int height, double width_m, double height_m, float base_m);
void tl_tile_release(struct tl_tile *tile);

/* A piece of a strand of round section. */
struct tl_strand {
    double x, y, z; /* of its axis */
    double radius;
    double along_x, along_y; /* unit, in the plane */
    double run;              /* metres from the strand's beginning */
    double ply_m;            /* a turn of its twist; 0: a single fibre */
    double melange;          /* how much the fibres of a yarn differ in colour, [0, 1] */
    float tint[3];
    uint32_t seed; /* of the strand */
};
void tl_tile_lay(struct tl_tile *tile, const struct tl_strand *strand);

/* The colour of the fibres of a yarn, a factor about 1: they lie side by side in lanes that follow its twist,
 * and each has a colour of its own for some way. `across` is in radii; the other arguments are a strand's. */
double tl_tile_fibres(uint32_t seed, double across, double run, double ply_m, double melange);

/* Multiplies tints by what valleys see of the sky, mixed by `share`, and keeps their mean, so that the cloth
 * has its colour from afar. */
void tl_tile_shade(struct tl_tile *tile, float share);

/* Evens out what is wider than a fifth of the tile, which would show from afar as a pattern of tiles: heights
 * lose their mean there, colours keep the tile's. */
void tl_tile_even_heights(struct tl_tile *tile);
void tl_tile_even_tints(struct tl_tile *tile);

/* The maps of a weave from the tile: normals by central differences and leans, gloss 0, heights about their
 * mean. */
tl_weave tl_tile_weave(const struct tl_tile *tile);

/* A number in [0, 1) by two integers and a seed. */
double tl_tile_random(uint32_t seed, int64_t i, int64_t j);
/* Smooth noise in [-1, 1] over x with the period `period`, an integer. */
double tl_tile_noise(uint32_t seed, double x, int period);

#endif
