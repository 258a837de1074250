/* The rigid motion that maps one set of points onto another with the least sum of squared distances. Threads:
 * pure. */
#ifndef TOILE_CLOTH_MESH_RIGID_H
#define TOILE_CLOTH_MESH_RIGID_H

#include "cloth/mesh/vec3d.h"

#include <stddef.h>

struct tl_rigid {
    vec3d from, to;    /* centroids of both sets */
    vec3d rotation[3]; /* rows */
};

/* Fits the motion to `count` pairs of points, metres. */
struct tl_rigid tl_rigid_fit(const vec3s *from, const vec3s *to, size_t count);

/* Apply the rotation to a direction, and the whole motion to a point. */
vec3d tl_rigid_turn(const struct tl_rigid *rigid, vec3d direction);
vec3d tl_rigid_point(const struct tl_rigid *rigid, vec3d point);

#endif
