/* The part of tangent frames that depends on connectivity and UVs only: which corners of triangles share a
 * normal, and which a tangent. Built once per mesh; tangent_layout.h arranges it for streaming.
 *
 * A corner is 3 * triangle + 0, 1 or 2. Ownership: plain struct that owns its arrays. Threads: pure. */
#ifndef TOILE_CLOTH_TANGENTS_TANGENT_GROUPS_H
#define TOILE_CLOTH_TANGENTS_TANGENT_GROUPS_H

#include "assets/base/mesh.h"

struct tl_tangent_groups {
    size_t render_count, corner_count; /* of triangles whose corners are three different places */
    uint32_t *vertices;                /* [corner_count] render vertex */
    uint32_t *normals;                 /* [corner_count] its normal */
    size_t normal_count;
    uint32_t *normal_of; /* [render_count] each normal is some vertex's */
    /* Tangent direction of a triangle = edge01 * [0] + edge02 * [1], of any positive length; 0 without UV
     * area. */
    double (*gradients)[2]; /* [corner_count / 3] */
    size_t group_count;
    uint32_t *groups;   /* [corner_count], TL_NONE where MikkTSpace has none */
    float *group_signs; /* [group_count] handedness */
    uint32_t *group_of; /* [render_count] the group that a vertex shows, or TL_NONE */
};

struct tl_tangent_groups tl_tangent_groups_build(const tl_mesh *mesh, const uint32_t *weld);
void tl_tangent_groups_release(struct tl_tangent_groups *groups);

/* For the half edge from each corner to the next: the one that runs the other way between the same two
 * `vertices` in another triangle, or TL_NONE. The k-th of one direction meets the k-th of the other. Free it.
 */
uint32_t *tl_twins_build(const uint32_t *vertices, size_t corner_count);

/* The corners beside this one at its vertex, across the edge to the triangle's last corner and across that to
 * its next; TL_NONE at a border. */
uint32_t tl_twins_after(const uint32_t *twins, uint32_t corner);
uint32_t tl_twins_before(const uint32_t *twins, uint32_t corner);

/* The corner `by` places on in the same triangle. */
static inline uint32_t tl_corner_turn(uint32_t corner, uint32_t by)
{
    return corner - corner % 3 + (corner + by) % 3;
}

#endif
