/* Bumped normals: Blinn's form and the shorter ones that stand for it [004]. World or any other space; pure.
 */
#ifndef TOILE_RENDER_DETAIL_BUMPS_H
#define TOILE_RENDER_DETAIL_BUMPS_H

#include <cglm/struct.h>

/* N' = N + h_u (N_n x P_v) + h_v (P_u x N_n), N = P_u x P_v, normalised [Blinn 1978]; `normal` is N_n, which
 * a mesh smooths, so that N = |P_u x P_v| N_n. Heights in the unit of positions; derivatives by the same u
 * and v. Where P_u x P_v points the other way (v down, mirrored UVs) its sign turns the offsets over with it.
 * `normal` where the surface has no such derivatives. */
vec3s tl_blinn_normal(vec3s normal, vec3s p_u, vec3s p_v, float h_u, float h_v);

/* The square patch: x tangent + y bitangent + z normal, normalised; for a tangent-space normal (-h_x, -h_y,
 * 1), or a multiple of it, by slopes in metres a metre. `handedness` as MikkTSpace has it. */
vec3s tl_patch_normal(vec3s normal, vec3s tangent, float handedness, vec3s mapped);

#endif
