/* Makes a Delaunay triangulation follow an outline. Threads: pure. */
#ifndef TOILE_ASSETS_SEWING_DELAUNAY_RING_H
#define TOILE_ASSETS_SEWING_DELAUNAY_RING_H

#include "assets/sewing/panel.h"

#include <stdbool.h>

/* Puts every side of the ring of the first `ring_count` points into the triangulation: what a missing side
 * crosses is triangulated again on both sides of it [Anglada 1997]. False when the ring crosses or touches
 * itself: then some of its sides are still missing. */
bool tl_delaunay_follow(const struct tl_point *points, size_t ring_count, uint32_t (*triangles)[3],
                        size_t triangle_count);

#endif
