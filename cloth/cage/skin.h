/* Moves the vertices of a fine mesh by the rigid motions of the vertices of a coarse one, its bones: linear
 * blend skinning [Magnenat-Thalmann et al. 1988]. What is finer than the coarse mesh, wrinkles and facets,
 * moves along rigidly.
 *
 * Weights: those of the places on the coarse triangles are hats, whose sides would show as creases of what
 * moves. They are diffused over the fine mesh's edges until the second moment sum w_j |x - x_j|^2 is nearly
 * constant, as that of a B-spline is: the motion of a surface that bends evenly then has an even error, and
 * no dents. Only the TL_SKIN_BONES largest weights of a vertex are kept,
 * lessened by the next one, so that a bone that comes or goes has the weight 0.
 *
 * Metres. Lifetime: plain structs that own their arrays. Threads: parallel inside, with the same results at
 * any number of threads. */
#ifndef TOILE_CLOTH_CAGE_SKIN_H
#define TOILE_CLOTH_CAGE_SKIN_H

#include "cloth/mesh/rigid.h"
#include "cloth/mesh/topology.h"

#define TL_SKIN_BONES 8 /* of a vertex, at most */

/* All borrowed. */
struct tl_skin_source {
    const struct tl_topology *topology; /* of the fine mesh */
    size_t bone_count;
    const uint32_t (*corners)[3]; /* [vertex_count] the bones around a vertex; TL_NONE: it has no place */
    const double (*shares)[3];    /* [vertex_count] not negative, with the sum 1 */
};

struct tl_skin {
    size_t vertex_count;
    uint8_t *counts;                  /* [vertex_count] bones; 0: it does not move */
    uint32_t (*bones)[TL_SKIN_BONES]; /* [vertex_count] */
    double (*weights)[TL_SKIN_BONES]; /* [vertex_count] their sum is 1 */
};

struct tl_skin tl_skin_make(const struct tl_skin_source *source);
void tl_skin_release(struct tl_skin *skin);

/* The position to which `motions` [bone] move the point `from` of a vertex that has bones. */
vec3d tl_skin_point(const struct tl_skin *skin, size_t vertex, const struct tl_rigid *motions, vec3d from);

#endif
