/* Cusick's drape test (BS 5058, ISO 9073-9) of the specimen "disc" (assets/specimen/specimen.h): a disc of
 * cloth hangs over the edge of round plates that hold its middle. The drape coefficient is the share of the
 * hanging ring that its shadow keeps when light falls straight down: DC = (A_shadow - A_plate) / (A_disc -
 * A_plate), 0: hangs straight down, 1: stays level. Metres, world axes, the axis of the plates at x = z = 0.
 * Threads: pure. */
#ifndef TOILE_ASSETS_SPECIMEN_CUSICK_H
#define TOILE_ASSETS_SPECIMEN_CUSICK_H

#include "assets/base/garment.h"

#define TL_CUSICK_DISC_M   0.15 /* radius */
#define TL_CUSICK_PLATE_M  0.09
#define TL_CUSICK_HEIGHT_M 0.40 /* of the level disc */

/* The shadow on a square of TL_CUSICK_SIDE_M a side about the axis: 1 where cloth is above a texel's centre,
 * else 0. Rows run along +Z. */
#define TL_CUSICK_SHADOW 640
#define TL_CUSICK_SIDE_M (2 * 1.05 * TL_CUSICK_DISC_M)

/* `positions` of the garment's render vertices. U8 x1; the caller releases it. */
tl_image tl_cusick_shadow(const tl_garment *disc, const vec3s *positions);
double tl_cusick_coefficient(const tl_image *shadow);

/* The number of folds: the largest Fourier component of the rim's height around the disc, from 2 to 16. */
int tl_cusick_folds(const tl_garment *disc, const vec3s *positions);

#endif
