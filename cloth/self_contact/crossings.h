/* Pairs of the cloth's own triangles that cross: an edge of one passes through the other. Edges and triangles
 * with a common vertex touch, which is no crossing; so triangles with a common edge never cross, and of
 * triangles with a common corner only the sides opposite to it can.
 *
 * The test is by signs of volumes in double precision; a touch without a passage does not count. Metres.
 * Errors: none. Threads: pure. */
#ifndef TOILE_CLOTH_SELF_CONTACT_CROSSINGS_H
#define TOILE_CLOTH_SELF_CONTACT_CROSSINGS_H

#include "assets/base/mesh.h"
#include "cloth/self_contact/near_tree.h"

#include <stdbool.h>

/* Whether the segment from p to q passes through the triangle a b c. */
bool tl_segment_crosses(vec3d p, vec3d q, vec3d a, vec3d b, vec3d c);

/* Whether two triangles of a mesh cross. */
bool tl_triangles_cross(const uint32_t a[3], const uint32_t b[3], const vec3d *x);

/* Replaces `out` by the crossing pairs, each once, in an order that depends on the tree only. Where more than
 * out->limit pairs of boxes overlap, only about as many are tested, and out->cut_short is set. `tree` is that
 * of the topology and is refitted to `x`. Takes 2 ms for 6,000 triangles. */
void tl_crossings_find(struct tl_near_tree *tree, const struct tl_topology *topology, const vec3d *x,
                       struct tl_near_pairs *out);

/* The number of crossing pairs of positions as they are drawn, that is, rounded to single precision. `tree`
 * is as for tl_crossings_find; NULL: one is built, which takes longer than the search. */
size_t tl_crossings_count(struct tl_near_tree *tree, const struct tl_topology *topology, const vec3d *x);

/* Replaces `out` by the crossing pairs of a mesh, as numbers of its triangles, with its vertices at
 * `positions` [vertex_count]; those at the same place are one. Of a mesh whose triangles all lie in one heap,
 * which is a damaged file, only some pairs are tested, and out->cut_short is set. 8 ms for 6,000 triangles.
 */
void tl_crossings_of_mesh(const tl_mesh *mesh, const vec3s *positions, struct tl_near_pairs *out);

#endif
