/* Loops of knitted fabrics: a yarn's axis in each course is a sine form of the plain loop,
 *
 *     x = W (i + t/2pi + 0.26 sin 2t),  y = H (j + 1/2 - 0.85 cos t),  z = -(d/2) cos 2t,   t in [0, 2 pi)
 *
 * for wale i and course j, W and H their spacings, d the yarn's diameter: on the face the legs lie in front,
 * on the purl side z is mirrored. A common sketch of the loop's geometry, not a mechanical model of it. */
#ifndef TOILE_ASSETS_WEAVE_KNIT_H
#define TOILE_ASSETS_WEAVE_KNIT_H

#include "assets/weave/tile.h"
#include "assets/weave/weave.h"

/* The loops of a tile of about 16 mm, whole repeats. The caller releases it. */
struct tl_tile tl_knit_lay(const struct tl_weave_params *params);

/* Lays the fibres of a nap over a tile: params->nap times its area, in wild curves; `tint` is their colour.
 */
void tl_nap_lay(const struct tl_weave_params *params, const float tint[3], struct tl_tile *tile);
/* The clumps of a pile without yarns: a flat tile of about 20 mm. */
struct tl_tile tl_pile_make(const struct tl_weave_params *params);

#endif
