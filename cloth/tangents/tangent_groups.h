/* The part of tangent frames that depends on connectivity and UVs only: the sets of triangle corners that
 * share a normal, and the sets that share a tangent (the groups of MikkTSpace [Mikkelsen 2008]). Built once
 * per mesh; tangent_layout.h arranges it for streaming.
 *
 * Corner c is corner c % 3 of triangle c / 3. Errors: none. Lifetime: plain struct that owns its arrays.
 * Threads: pure. */
#ifndef TOILE_CLOTH_TANGENTS_TANGENT_GROUPS_H
#define TOILE_CLOTH_TANGENTS_TANGENT_GROUPS_H

#include "assets/base/mesh.h"

struct tl_tangent_groups {
    size_t render_count, corner_count; /* corner_count: of triangles with three different normals */
    uint32_t *vertices;                /* [corner_count] render vertex */
    uint32_t *normals;                 /* [corner_count] index of its normal */
    size_t normal_count;
    uint32_t *normal_of; /* [render_count] index of its normal; every normal has a vertex */
    /* Tangent direction of a triangle = edge01 * [0] + edge02 * [1], of arbitrary positive length; both 0
     * without UV area. */
    double (*gradients)[2]; /* [corner_count / 3] */
    size_t group_count;
    uint32_t *groups;   /* [corner_count] TL_NONE where MikkTSpace assigns none */
    float *group_signs; /* [group_count] handedness */
    uint32_t *group_of; /* [render_count] the group whose tangent the vertex uses, or TL_NONE */
};

/* `weld` [vertex_count]: welded vertex of each render vertex. A mesh without UVs has no groups. End with
 * tl_tangent_groups_release. */
struct tl_tangent_groups tl_tangent_groups_build(const tl_mesh *mesh, const uint32_t *weld);
void tl_tangent_groups_release(struct tl_tangent_groups *groups);

/* The twin of each half edge from a corner to the next: the half edge in the opposite direction between the
 * same two `vertices` [corner_count], named by its first corner, or TL_NONE. On an edge of more than two
 * triangles the k-th of one direction is paired with the k-th of the other. The caller frees the array. */
uint32_t *tl_twins_build(const uint32_t *vertices, size_t corner_count);

/* The adjacent corners at the same vertex: `after` across the edge to the triangle's previous corner,
 * `before` across the edge to its next corner. TL_NONE at a border. */
uint32_t tl_twins_after(const uint32_t *twins, uint32_t corner);
uint32_t tl_twins_before(const uint32_t *twins, uint32_t corner);

/* The corner that follows by `by` (0 to 2) in the same triangle. */
static inline uint32_t tl_corner_turn(uint32_t corner, uint32_t by)
{
    return corner - corner % 3 + (corner + by) % 3;
}

#endif
