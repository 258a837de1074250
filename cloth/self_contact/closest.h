/* Nearest points of a point and a triangle, and of two segments [Ericson 2005, 5.1.5 and 5.1.9]. Degenerate
 * triangles and segments give the nearest of what is left of them. Threads: pure. */
#ifndef TOILE_CLOTH_SELF_CONTACT_CLOSEST_H
#define TOILE_CLOTH_SELF_CONTACT_CLOSEST_H

#include "cloth/mesh/vec3d.h"
#include "config/base/simd.h"

/* Barycentric weights of the point of triangle a b c nearest to p. */
void tl_closest_on_triangle(vec3d p, vec3d a, vec3d b, vec3d c, double weights[3]);

/* The nearest points p0 + s (p1 - p0) and q0 + t (q1 - q0). */
void tl_closest_on_segments(vec3d p0, vec3d p1, vec3d q0, vec3d q1, double *s, double *t);

/* The corners of TL_LANES pairs of features, lane by lane: point[corner][axis][lane]. */
struct tl_closest_lanes {
    float point[4][3][TL_LANES];
};

/* Lower bounds of the distances of segments point[0] point[1] and point[2] point[3], and of points point[0]
 * and triangles point[1] point[2] point[3]: less than the distances of these points by at most
 * TL_CLOSEST_LOSS of the longest side. */
#define TL_CLOSEST_LOSS 3e-3f
void tl_closest_segment_bounds(const struct tl_closest_lanes *lanes, float bounds[TL_LANES]);
void tl_closest_triangle_bounds(const struct tl_closest_lanes *lanes, float bounds[TL_LANES]);

#endif
