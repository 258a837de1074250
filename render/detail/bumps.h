/* Bumped normals by Blinn's form; bumps_terms.glsl has the shorter one that approximates it. In any space;
 * pure; threads: any. */
#ifndef TOILE_RENDER_DETAIL_BUMPS_H
#define TOILE_RENDER_DETAIL_BUMPS_H

#include "assets/base/surface.h"

#include <cglm/struct.h>

/* Blinn's bumped normal: N' = N + h_u (N_n x P_v) + h_v (P_u x N_n), N = P_u x P_v, normalised [Blinn 1978].
 * `normal` is N_n, the interpolated normal of a mesh, so that N = |P_u x P_v| N_n. Heights have the unit of
 * positions; h and P are differentiated by the same u and v. Where P_u x P_v points to the other side (v
 * down, mirrored UVs) its sign is applied to the offsets. Returns `normal` where the surface has no such
 * derivatives. */
vec3s tl_blinn_normal(vec3s normal, vec3s p_u, vec3s p_v, float h_u, float h_v);

/* The change of a point with its UV within a triangle: the derivatives of the point by u and by v,
 * metres per UV unit. False, and zeros, where the UVs span no area. */
bool tl_uv_derivatives(const vec3s positions[3], const vec2s uvs[3], vec3s *p_u, vec3s *p_v);

/* The same at vertices: sums over the triangles around each, by their areas, over these areas. `p_u` and
 * `p_v` have room for all vertices [Wimmer n.d., Creating Tangent Space]. */
void tl_vertex_derivatives(const tl_surface *surface, vec3s *p_u, vec3s *p_v);

/* The factors on a weave's slopes along u and v where the triangle is stretched (detail_slope_factor), as in
 * detail.glsl. `nominal`: metres of the UV unit to which the bumps are made. 1 where the UVs span no area. */
void tl_slope_factors(const vec3s positions[3], const vec2s uvs[3], float nominal, float out[2]);

#endif
