#include "cloth/solvers/relaxation.h"

TL_CLONES static void relax(struct tl_particles *particles, struct tl_range part, const void *params)
{
    const struct tl_relaxation to = *(const struct tl_relaxation *)params;
    double weights[3 * TL_PARTICLE_GROUP];
    for (size_t first = part.from; first < part.to; first += TL_PARTICLE_GROUP) {
        const size_t left = part.to - first, count = left < TL_PARTICLE_GROUP ? left : TL_PARTICLE_GROUP;
        double *restrict x = &particles->x[first].x, *restrict previous = &particles->previous[first].x;
        double *restrict v = &particles->v[first].x;
        const double *restrict forces = &to.forces[first].x, *restrict loads = &to.loads[first].x;
        tl_group_weights(&particles->w[first], count, weights);
        for (size_t k = 0; k < 3 * count; k++) {
            double speed = to.keep * v[k] + to.h * weights[k] * (forces[k] + loads[k]);
            speed = weights[k] > 0 ? speed : 0;
            previous[k] = x[k];
            x[k] += to.h * speed;
            v[k] = speed;
        }
    }
}

struct tl_particle_kernel tl_relaxation_kernel(struct tl_particles *particles,
                                               const struct tl_relaxation *relaxation)
{
    return (struct tl_particle_kernel){relax, particles, relaxation};
}

void tl_relaxation_masses(const double *sums, const double *held, size_t vertex_count, double h,
                          double *inverse_masses)
{
    for (size_t i = 0; i < vertex_count; i++)
        inverse_masses[i] = held[i] > 0 && sums[i] > 0 ? 4 / (h * h * sums[i]) : 0;
}
