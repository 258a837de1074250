/* The origins of the samples' rays: a little above the smooth surface that a triangle approximates. A hash
 * records whether the samples are those of the last frame. Part of points.c. */
#ifndef TOILE_RENDER_VISIBILITY_RAY_ORIGINS_H
#define TOILE_RENDER_VISIBILITY_RAY_ORIGINS_H

#include "render/visibility/points_request.h"

struct tl_ray_origins {
    size_t capacity;
    vec3s *points;    /* [samples], world, metres */
    uint64_t samples; /* a hash of what they start from */
};

void tl_ray_origins_make(const struct tl_points_request *request, struct tl_ray_origins *out);
void tl_ray_origins_release(struct tl_ray_origins *origins);

#endif
