/* The steps that all methods of cutting share: from labels to a complete tl_regions. Included within
 * render/pem only. A cut calls tl_regions_begin, sets `count`, `labels` and its nodes, then calls the others
 * in the order of this header. */
#ifndef TOILE_RENDER_PEM_REGIONS_INTERNAL_H
#define TOILE_RENDER_PEM_REGIONS_INTERNAL_H

#include "render/pem/regions.h"

/* Smaller cubes are processed by one thread, because starting others takes longer. */
#define TL_REGIONS_PARALLEL_TEXELS 16384

/* Releases the contents of `out`, allocates it, and fills in `size`, `solid_angles` and `importance` from the
 * cube. */
void tl_regions_begin(const tl_cube *cube, struct tl_regions *out);
/* Fills in `texels` and `first`. */
void tl_regions_order(struct tl_regions *regions);
/* Fills in direction, solid_angle, importance and cone of the items. */
void tl_regions_measure(struct tl_regions *regions);
/* Fills in `cumulative`, and the spread of the items about their direction. */
void tl_regions_weigh(struct tl_regions *regions);
/* Fills in the power of the items. */
void tl_regions_colour(const tl_cube *cube, struct tl_regions *regions);

#endif
