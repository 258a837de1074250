/* Delaunay triangulation of a planar point set [Bowyer 1981; Watson 1981], for up to some ten thousand points
 * without duplicates. Threads: pure. */
#ifndef TOILE_ASSETS_SEWING_DELAUNAY_H
#define TOILE_ASSETS_SEWING_DELAUNAY_H

#include "assets/sewing/panel.h"

/* Counter-clockwise triangles that cover the convex hull; *triangles is a new array. Returns their count. */
size_t tl_delaunay(const struct tl_point *points, size_t count, uint32_t (**triangles)[3]);

#endif
