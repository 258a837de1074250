/* Tangent frames of a moving mesh: normals and tangents, updated every frame.
 *
 * Normals are angle-weighted, one per physics (welded) vertex. Tangents are those of MikkTSpace, per render
 * vertex. The groups, signs and degenerate flags of MikkTSpace depend on connectivity and UVs only, so they
 * are found once (tangent_groups.h), as is the order in which fans of triangles are read (tangent_layout.h);
 * each frame only streams positions. A vertex with degenerate UVs keeps its last tangent, made orthogonal to
 * its normal, or takes any orthogonal direction; a fan without area keeps its last normal, at first +Y.
 * Results are always finite, orthonormal to 1e-5, with w = +1 or -1, even where positions are not finite.
 *
 * Vertices at one position share a normal even if the file split them, except the back of a sheet that is
 * modelled from both sides. MikkTSpace's tangents are per corner: a render vertex whose corners are in
 * several groups (where UVs are mirrored) takes the group of most of its corners, the first of equals. w
 * follows the meshes' v, which runs down: the bitangent points to smaller v, up in a normal map. Triangles
 * without UV area contribute nothing, but groups extend across them.
 *
 * Lifetime: copies what it needs. Threads: one update at a time per object, parallel inside; results are the
 * same at any number of threads. */
#ifndef TOILE_CLOTH_TANGENTS_TANGENT_FRAMES_H
#define TOILE_CLOTH_TANGENTS_TANGENT_FRAMES_H

#include "assets/base/mesh.h"

typedef struct tl_tangent_frames tl_tangent_frames;

/* `weld` [vertex_count] from tl_weld_positions or tl_cloth_weld; the object must be recreated when that
 * changes. Takes about 1.5 us per vertex. Cannot fail. End with tl_tangent_frames_destroy, which sets the
 * handle to NULL and ignores NULL. */
tl_tangent_frames *tl_tangent_frames_create(const tl_mesh *mesh, const uint32_t *weld);
void tl_tangent_frames_destroy(tl_tangent_frames **frames);

/* Computes `normals` and `tangents` [vertex_count] from `positions` [vertex_count], metres. Welded vertices
 * are taken to be at the position of the first of them. Takes about 20 ns per vertex on one core. */
void tl_tangent_frames_update(tl_tangent_frames *frames, const vec3s *positions, vec3s *normals,
                              vec4s *tangents);

/* Forgets the last normals and tangents: later updates equal those of a new object. */
void tl_tangent_frames_reset(tl_tangent_frames *frames);

#endif
