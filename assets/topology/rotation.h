/* The rotation about their centroids that maps one set of points onto another with the least sum of squared
 * distances [Horn 1987]. Threads: pure. */
#ifndef TOILE_ASSETS_TOPOLOGY_ROTATION_H
#define TOILE_ASSETS_TOPOLOGY_ROTATION_H

#include <cglm/struct.h>

struct tl_rotation {
    double from[3], to[3]; /* centroids of both sets */
    double rows[3][3];
};

/* Fits the rotation to `count` pairs of points; the identity where there are none. */
struct tl_rotation tl_rotation_fit(const vec3s *from, const vec3s *to, size_t count);

#endif
