/* A garment's pieces laid out flat, side by side, for a look at its pattern. Metres. Threads: pure. */
#ifndef TOILE_ASSETS_SEWING_LAYOUT_H
#define TOILE_ASSETS_SEWING_LAYOUT_H

#include "assets/base/garment.h"

/* Between pieces. */
#define TL_LAYOUT_GAP_M 0.02f

/* Lays the pieces of garment->pattern on a table: tallest first, in rows, each as wide as its table. Pieces
 * are not turned, so that the warp stays upright, and not scaled; those whose pattern is mirrored are turned
 * over, so that all show their outer side. A piece is what triangles connect, over vertices that are at one
 * place both in the pattern and in the mesh.
 *
 * out [mesh.vertex_count]: from the table's lower left corner; vertices without triangles are there. *size:
 * the table's width and height. False when the garment has no pattern, and nothing is written. */
bool tl_layout_make(const tl_garment *garment, vec2s *out, vec2s *size);

#endif
