/* Nearest points of a point and a triangle, and of two segments (Ericson, "Real-Time Collision Detection",
 * 2005, 5.1.5 and 5.1.9). Degenerate triangles and segments give the nearest of what is left of them.
 * Threads: pure. */
#ifndef TOILE_CLOTH_CONTACT_CLOSEST_H
#define TOILE_CLOTH_CONTACT_CLOSEST_H

#include "cloth/mesh/vec3d.h"

/* Barycentric weights of the point of triangle a b c nearest to p. */
void tl_closest_on_triangle(vec3d p, vec3d a, vec3d b, vec3d c, double weights[3]);

/* The nearest points p0 + s (p1 - p0) and q0 + t (q1 - q0). */
void tl_closest_on_segments(vec3d p0, vec3d p1, vec3d q0, vec3d q1, double *s, double *t);

#endif
