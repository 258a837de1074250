/* What cloth rests on: a closed triangle mesh that may move from frame to frame, and the ground plane y = 0.
 *
 * Closest points come from Embree's point queries on a BVH over the welded mesh, the side from the
 * angle-weighted pseudo-normal of the closest feature (Baerentzen & Aanaes 2005). Metres, world. Ownership:
 * owns its copies. Threads: queries may run on several threads, moves may not. */
#ifndef TOILE_CLOTH_COLLIDER_H
#define TOILE_CLOTH_COLLIDER_H

#include "assets/mesh.h"
#include "config/error.h"

typedef struct tl_collider tl_collider;

/* `mesh` may be NULL: ground only. `ground` false: no plane. */
tl_collider *tl_collider_create(const tl_mesh *mesh, bool ground, tl_error *error);
void tl_collider_destroy(tl_collider **collider);

/* New positions of the mesh's render vertices: the current pose becomes the previous one. Moving twice to the
 * same positions brings it to rest. */
void tl_collider_move(tl_collider *collider, const vec3s *positions);

/* Signed distance of a point to the current mesh (negative inside) and the outward unit direction of its
 * gradient; points farther than `reach_m` give false. The ground is not part of it. */
struct tl_contact {
    double distance_m;
    double normal[3];
    uint32_t triangle; /* of the mesh */
    double barycentric[3];
};
bool tl_collider_query(const tl_collider *collider, const double point[3], double reach_m,
                       struct tl_contact *out);

#endif
