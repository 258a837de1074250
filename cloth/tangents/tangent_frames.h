/* Normals and tangents of a moving mesh, every frame.
 *
 * Normals per physics (welded) vertex, angle-weighted; tangents per render vertex, MikkTSpace's: the groups,
 * signs and degenerate flags of MikkTSpace depend on connectivity and UVs only, so they are built once
 * (frames_groups), and with them the order in which fans of triangles are read (frames_lay); each frame
 * streams positions. A vertex whose UVs are degenerate keeps its last tangent, made orthogonal to its normal,
 * or takes any orthogonal direction. Always finite, orthonormal to 1e-5, w = +1 or -1, also where positions
 * are not finite; a zero-area fan keeps its last normal, at first +Y.
 *
 * Cloth is smooth: vertices at one place share a normal even where the file split them, but for the back of a
 * sheet that is drawn from both sides. MikkTSpace's tangents are per corner; a render vertex whose corners
 * are in several groups (on a line where UVs mirror) takes the group of most of its corners, the first of
 * equals. w follows the meshes' v, which runs down: the bitangent points to smaller v, up in a normal map.
 * Triangles without UV area add nothing, but groups spread over them. Threads: one update at a time per
 * object, in parallel inside; results are the same at any thread count. */
#ifndef TOILE_CLOTH_TANGENTS_TANGENT_FRAMES_H
#define TOILE_CLOTH_TANGENTS_TANGENT_FRAMES_H

#include "assets/base/mesh.h"

typedef struct tl_tangent_frames tl_tangent_frames;

/* `weld` from tl_weld_positions or tl_cloth_weld, to be made anew when that changes: vertex_count entries.
 * Copies what it needs. Takes about 1.5 us a vertex. */
tl_tangent_frames *tl_tangent_frames_create(const tl_mesh *mesh, const uint32_t *weld);
void tl_tangent_frames_destroy(tl_tangent_frames **frames);

/* vertex_count of each. Vertices that are welded are where the first of them is. Takes about 20 ns a vertex
 * on one core. */
void tl_tangent_frames_update(tl_tangent_frames *frames, const vec3s *positions, vec3s *normals,
                              vec4s *tangents);

/* Nothing is kept of updates so far: the next ones are what they would be after tl_tangent_frames_create. */
void tl_tangent_frames_reset(tl_tangent_frames *frames);

#endif
