/* The collider: a closed triangle mesh that may move from frame to frame, and the ground plane y = 0.
 *
 * Closest points come from Embree's point queries on a BVH over the welded mesh, the side from the
 * angle-weighted pseudo-normal of the closest feature [Baerentzen and Aanaes 2005]. Metres, world. Lifetime:
 * copies the mesh. Threads: queries may run concurrently, but not with a move. */
#ifndef TOILE_CLOTH_CONTACT_COLLIDER_H
#define TOILE_CLOTH_CONTACT_COLLIDER_H

#include "assets/base/mesh.h"
#include "cloth/mesh/rigid.h"
#include "cloth/mesh/vec3d.h"
#include "config/base/error.h"

typedef struct tl_collider tl_collider;

/* `mesh` NULL: no mesh; `ground` false: no plane. Errors: TL_INPUT for a vertex that is not finite, TL_DEVICE
 * if Embree fails; returns NULL then. End with tl_collider_destroy, which sets the handle to NULL and ignores
 * NULL. */
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

/* The same while it moves: `phase` 0 is the previous pose, 1 the current one. */
bool tl_collider_query_at(const tl_collider *collider, const double point[3], double phase, double reach_m,
                          struct tl_contact *out);

/* Winding number of the current surface around a point: 1 inside, 0 outside, also near creases. A pose that
 * pushes the surface through itself has creases that are inside out: a point outside that is nearest to the
 * back of one has a negative distance. Sums the solid angles of all triangles [Van Oosterom and Strackee
 * 1983], so it is for few points. */
double tl_collider_winding(const tl_collider *collider, const double point[3]);

/* A point of a triangle in the previous and in the current pose. */
void tl_collider_path(const tl_collider *collider, uint32_t triangle, const double barycentric[3],
                      double previous[3], double current[3]);

/* The welded vertices of the surface, on the way from the previous pose to the current one: `out`
 * [tl_collider_skin_count]. The normal is the mean of the faces', by their area. */
struct tl_skin_vertex {
    vec3d x, normal;
    double point; /* height above the mean of its neighbours, as a share of their mean distance */
};
size_t tl_collider_skin_count(const tl_collider *collider);
void tl_collider_skin(const tl_collider *collider, double phase, struct tl_skin_vertex *out);

bool tl_collider_has_ground(const tl_collider *collider);

/* Largest displacement of a vertex from the previous to the current pose, m. */
double tl_collider_travel(const tl_collider *collider);

/* A move with a larger displacement (15 m/s at 30 frames a second) is a jump. The rigid motion nearest to it
 * is then applied to the previous pose, so that only the rest remains as motion, and tl_collider_jump returns
 * it while the revision stays the same, so that worn cloth can be moved along. */
#define TL_COLLIDER_JUMP_M 0.5
bool tl_collider_jump(const tl_collider *collider, struct tl_rigid *out);

/* Increases with every move that changes a pose; results of queries stay valid while it is the same. */
uint64_t tl_collider_revision(const tl_collider *collider);

#endif
