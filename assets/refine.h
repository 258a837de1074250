/* Coarse garments made fine: cloth folds along the edges of its mesh only, and what is kept at vertices, the
 * visibility of light for one, is a straight line between them. Edges longer than a length are halved until
 * none is. Whether an edge is halved, and where, follows from its two ends alone, so that pieces which met
 * along an edge of equal ends still do. Flat triangles stay flat: the shape is what it was. Pure. */
#ifndef TOILE_ASSETS_REFINE_H
#define TOILE_ASSETS_REFINE_H

#include "assets/base/garment.h"
#include "config/error.h"

/* Of a garment from a file, neither sewn nor with a pattern. Old vertices keep their numbers; what is new
 * takes the mean of what its edge's ends have, and is pinned where both are. The garment follows no
 * skeleton any more when anything was split. False when it would get larger than TL_LIMIT_MESH_*, which is
 * known before memory is asked for: then it is fit to be released only. */
bool tl_garment_refine(tl_garment *garment, float longest_m, tl_error *error);

/* Of all triangles; 0 without any. */
float tl_mesh_longest_edge(const tl_mesh *mesh);

#endif
