/* A garment whose file has stitches is sewn by them: they become seams, one vertex against one vertex.
 *
 * Codim-IPC's OBJ files [Li et al. 2021] hold panels
 * in space, their pattern as texture coordinates, and lines
 *
 *     stitch A B C t      vertex A is sewn to the point (1 - t) B + t C of an edge; vertices count from 0
 *
 * Welding takes pairs of vertices, so a stitch goes to the nearer end of its edge. Where the sides of a seam
 * are not divided alike, an edge of the coarser side is divided, so that no vertex between two stitches is
 * left over. Metres. Threads: one per garment. */
#ifndef TOILE_ASSETS_SEWING_STITCHES_H
#define TOILE_ASSETS_SEWING_STITCHES_H

#include "assets/base/garment.h"

struct tl_stitches_report {
    size_t sewn;  /* pairs of points that seams join */
    size_t added; /* vertices, in edges between two stitches */
};

/* Makes the garment's seams from its model's stitches; leaves it as it is when there are none. New vertices
 * follow the old ones, which keep their indices. Panels are joined by stitches alone, not by where they
 * start. */
struct tl_stitches_report tl_stitches_sew(tl_garment *garment);

#endif
