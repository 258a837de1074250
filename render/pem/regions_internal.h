/* What every way of cutting shares: from labels to the rest of a tl_regions. For the files of this folder. */
#ifndef TOILE_RENDER_PEM_REGIONS_INTERNAL_H
#define TOILE_RENDER_PEM_REGIONS_INTERNAL_H

#include "render/pem/regions.h"

/* Cubes of fewer texels are done before other threads have woken up. */
#define TL_REGIONS_PARALLEL_TEXELS 16384

/* In this order: a cut begins, sets `count`, `labels` and the nodes it has, then lets the rest be made. */

/* Releases what `out` held, allocates, and fills in `size`, `solid_angles` and `importance`. */
void tl_regions_begin(const tl_cube *cube, struct tl_regions *out);
/* ... as `from` has them. */
void tl_regions_begin_like(const struct tl_regions *from, struct tl_regions *out);
/* texels, first. */
void tl_regions_order(struct tl_regions *regions);
/* direction, solid_angle, importance and cone of the items. */
void tl_regions_measure(struct tl_regions *regions);
/* cumulative; spread of the items about their direction. */
void tl_regions_weigh(struct tl_regions *regions);
/* power of the items. */
void tl_regions_colour(const tl_cube *cube, struct tl_regions *regions);

#endif
