#include "cloth/drive/hand.h"

#include <math.h>

/* The larger t with |from + t way| = longest, of a place within: 0 where it is there already and goes out. */
static double share_within(vec3d from, vec3d way, double longest)
{
    double a = vec3d_dot(way, way), b = vec3d_dot(from, way), c = vec3d_dot(from, from) - longest * longest;
    return a > 0 ? (sqrt(fmax(b * b - a * fmin(c, 0), 0)) - b) / a : 1;
}

double tl_hand_share(const struct tl_limits *limits, const struct tl_pulls *pulls,
                     const struct tl_particles *particles, uint32_t i, vec3d way)
{
    double share = 1;
    for (uint32_t k = pulls->along_first[i]; k < pulls->along_first[i + 1]; k++) {
        const struct tl_along *along = &pulls->along[k];
        double most = (1 + TL_HAND_STRAIN) * limits->edges[along->edge].rest;
        vec3d from = vec3d_sub(particles->x[i], particles->x[along->other]);
        if (isfinite(most))
            share = fmin(share, share_within(from, way, fmax(most, vec3d_norm(from))));
    }
    return fmax(share, 0);
}
