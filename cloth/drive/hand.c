#include "cloth/drive/hand.h"

#include <math.h>

/* The larger t with |from + t way| = longest, of a place within: 0 where it is there already and goes out. */
static double share_within(vec3d from, vec3d step, double longest)
{
    double a = vec3d_dot(step, step), b = vec3d_dot(from, step),
           c = vec3d_dot(from, from) - longest * longest;
    return a > 0 ? (sqrt(fmax(b * b - a * fmin(c, 0), 0)) - b) / a : 1;
}

double tl_hand_share(const struct tl_strain_limits *limits, const struct tl_pair_forces *pairs,
                     const struct tl_particles *particles, uint32_t i, vec3d step)
{
    double share = 1;
    for (uint32_t k = pairs->incident_first[i]; k < pairs->incident_first[i + 1]; k++) {
        const struct tl_incident_edge *incident = &pairs->incident[k];
        double most = (1 + TL_HAND_STRAIN) * limits->edges[incident->edge].rest;
        vec3d from = vec3d_sub(particles->x[i], particles->x[incident->other]);
        if (isfinite(most))
            share = fmin(share, share_within(from, step, fmax(most, vec3d_norm(from))));
    }
    return fmax(share, 0);
}
