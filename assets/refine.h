/* Refinement of coarse garments: cloth folds only along the edges of its mesh, and values stored at vertices,
 * such as visibility, are linear between them. Edges longer than a given length are halved until none is
 * left. Whether an edge is halved, and where, depends on its two ends alone, so that pieces that share an
 * edge still fit. Flat triangles stay flat, so the shape does not change. Threads: pure. */
#ifndef TOILE_ASSETS_REFINE_H
#define TOILE_ASSETS_REFINE_H

#include "assets/base/garment.h"
#include "config/base/error.h"

/* Refines a garment from a file that has neither seams nor a pattern. Old vertices keep their indices. A new
 * vertex takes the mean of the attributes of its edge's ends, and is pinned when both are. If any edge is
 * split, the garment loses its skeleton.
 *
 * Errors: false with a message when the mesh would exceed TL_LIMIT_MESH_*, which is known before memory is
 * allocated; the garment can then only be released. Lifetime: it stays the caller's. Threads: one per
 * garment. */
bool tl_garment_refine(tl_garment *garment, float longest_m, tl_error *error);

/* The longest edge of all triangles, metres; 0 without triangles. */
float tl_mesh_longest_edge(const tl_mesh *mesh);

#endif
