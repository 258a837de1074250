#include "cloth/solvers/verlet.h"

struct tl_verlet tl_verlet_make(const vec3d *forces, double gravity, double drag, double h)
{
    return (struct tl_verlet){forces, gravity, exp(-drag * h / 2), h};
}

/* v + h/2 a, for one coordinate. */
TL_INLINE double pushed(double v, double force, double weight, double gravity_step, double h)
{
    return v + force * (weight * h / 2) - gravity_step;
}

/* Kick, drift, or both, of `count` particles. Velocities are stored, not derived from positions: a position
 * of 1 m is rounded by 1e-16 m, which over a step of 1e-5 s would be an error of 1e-11 m/s in every step.
 * Only the displacement by constraints is divided by h; where there is none, the difference is exactly 0,
 * since the same expression previous + speed h is evaluated. */
TL_INLINE void advance(struct tl_particles *particles, size_t first, size_t count,
                       const struct tl_verlet *substep, const double gravity_steps[3 * TL_PARTICLE_GROUP],
                       bool kicks, bool drifts)
{
    const double h = substep->h, per_h = 1 / h, damping_factor = substep->damping_factor;
    double weights[3 * TL_PARTICLE_GROUP];
    tl_group_weights(&particles->w[first], count, weights);
    double *restrict x = &particles->x[first].x, *restrict v = &particles->v[first].x;
    double *restrict previous = &particles->previous[first].x;
    const double *restrict forces = &substep->forces[first].x;
    for (size_t k = 0; k < 3 * count; k++) {
        double speed = v[k], weight = weights[k];
        if (kicks) {
            speed += (x[k] - (previous[k] + speed * h)) * per_h;
            speed =
                weight > 0 ? pushed(speed, forces[k], weight, gravity_steps[k], h) * damping_factor : speed;
        }
        if (drifts) {
            speed = weight > 0 ? pushed(speed * damping_factor, forces[k], weight, gravity_steps[k], h) : 0;
            previous[k] = x[k];
            x[k] += speed * h;
        }
        v[k] = speed;
    }
}

TL_INLINE void advance_part(struct tl_particles *particles, struct tl_range part, const void *params,
                            bool kicks, bool drifts)
{
    const struct tl_verlet substep = *(const struct tl_verlet *)params;
    double gravity_steps[3 * TL_PARTICLE_GROUP];
    tl_group_gravity(substep.gravity * substep.h / 2, gravity_steps);
    size_t i = part.from;
    for (; i + TL_PARTICLE_GROUP <= part.to; i += TL_PARTICLE_GROUP)
        advance(particles, i, TL_PARTICLE_GROUP, &substep, gravity_steps, kicks, drifts);
    advance(particles, i, part.to - i, &substep, gravity_steps, kicks, drifts);
}

TL_CLONES static void drift(struct tl_particles *particles, struct tl_range part, const void *params)
{
    advance_part(particles, part, params, false, true);
}

TL_CLONES static void kick(struct tl_particles *particles, struct tl_range part, const void *params)
{
    advance_part(particles, part, params, true, false);
}

TL_CLONES static void leap(struct tl_particles *particles, struct tl_range part, const void *params)
{
    advance_part(particles, part, params, true, true);
}

void tl_verlet_drift(struct tl_particles *particles, const struct tl_verlet *substep)
{
    tl_particles_run(&(const struct tl_particle_kernel){drift, particles, substep});
}

struct tl_particle_kernel tl_verlet_kick(struct tl_particles *particles, const struct tl_verlet *substep)
{
    return (struct tl_particle_kernel){kick, particles, substep};
}

struct tl_particle_kernel tl_verlet_leap(struct tl_particles *particles, const struct tl_verlet *substep)
{
    return (struct tl_particle_kernel){leap, particles, substep};
}
