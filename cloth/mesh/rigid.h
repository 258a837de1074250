/* The rigid motion that takes one set of points nearest to another, in least squares (Horn 1987, "Closed-form
 * solution of absolute orientation using unit quaternions"). Threads: pure. */
#ifndef TOILE_CLOTH_MESH_RIGID_H
#define TOILE_CLOTH_MESH_RIGID_H

#include "cloth/mesh/vec3d.h"

#include <stddef.h>

struct tl_rigid {
    vec3d from, to;    /* the centres */
    vec3d rotation[3]; /* rows */
};

struct tl_rigid tl_rigid_fit(const vec3s *from, const vec3s *to, size_t count);

vec3d tl_rigid_turn(const struct tl_rigid *rigid, vec3d direction);
vec3d tl_rigid_point(const struct tl_rigid *rigid, vec3d point);

#endif
