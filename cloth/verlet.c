#include "cloth/verlet.h"

struct substep {
    const vec3d *forces;
    double gravity, keep, h; /* m/s^2, share of v that half the substep's drag leaves, s */
};

/* v + h/2 a, for one particle. */
static vec3d pushed(vec3d v, const struct substep *substep, size_t i, double w)
{
    v = vec3d_muladd(v, substep->forces[i], w * substep->h / 2);
    v.y -= substep->gravity * substep->h / 2;
    return v;
}

static void drift(struct tl_particles *particles, struct tl_range part, const void *how)
{
    const struct substep substep = *(const struct substep *)how;
    for (size_t i = part.from; i < part.to; i++) {
        double w = particles->w[i];
        vec3d x = particles->x[i], v = {0};
        if (w > 0)
            v = pushed(vec3d_scale(particles->v[i], substep.keep), &substep, i, w);
        particles->v[i] = v;
        particles->previous[i] = x;
        particles->x[i] = vec3d_muladd(x, v, substep.h);
    }
}

void tl_verlet_drift(struct tl_particles *particles, const vec3d *forces, double gravity, double drag,
                     double h)
{
    const struct substep substep = {forces, gravity, exp(-drag * h / 2), h};
    tl_particles_share(particles, drift, &substep);
}

/* Velocities are kept, not taken from the places: rounding of a place is 1e-16 m, over a step of 1e-5 s that
 * is 1e-11 m/s each time. What moved nobody adds exactly 0. */
static void kick(struct tl_particles *particles, struct tl_range part, const void *how)
{
    const struct substep substep = *(const struct substep *)how;
    double per_h = 1 / substep.h;
    for (size_t i = part.from; i < part.to; i++) {
        vec3d v = particles->v[i], driven = vec3d_muladd(particles->previous[i], v, substep.h);
        v = vec3d_muladd(v, vec3d_sub(particles->x[i], driven), per_h);
        if (particles->w[i] > 0)
            v = vec3d_scale(pushed(v, &substep, i, particles->w[i]), substep.keep);
        particles->v[i] = v;
    }
}

void tl_verlet_kick(struct tl_particles *particles, const vec3d *forces, double gravity, double drag,
                    double h)
{
    const struct substep substep = {forces, gravity, exp(-drag * h / 2), h};
    tl_particles_share(particles, kick, &substep);
}
