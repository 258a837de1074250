#include "cloth/verlet.h"

/* v + h a, for one particle. */
static vec3d pushed(vec3d v, vec3d force, double w, double gravity, double h)
{
    v = vec3d_muladd(v, force, w * h);
    v.y -= gravity * h;
    return v;
}

void tl_verlet_drift(struct tl_particles *particles, const vec3d *forces, double gravity, double drag,
                     double h)
{
    double keep = exp(-drag * h / 2);
    for (size_t i = 0; i < particles->count; i++) {
        double w = particles->w[i];
        vec3d v = {0};
        if (w > 0)
            v = pushed(vec3d_scale(particles->v[i], keep), forces[i], w, gravity, h / 2);
        particles->v[i] = v;
        particles->previous[i] = particles->x[i];
        particles->x[i] = vec3d_muladd(particles->x[i], v, h);
    }
}

/* Velocities are kept, not taken from the places: rounding of a place is 1e-16 m, over a step of 1e-5 s that
 * is 1e-11 m/s each time. What moved nobody adds exactly 0. */
void tl_verlet_kick(struct tl_particles *particles, const vec3d *forces, double gravity, double drag,
                    double h)
{
    double keep = exp(-drag * h / 2);
    for (size_t i = 0; i < particles->count; i++) {
        vec3d v = particles->v[i], driven = vec3d_muladd(particles->previous[i], v, h);
        v = vec3d_muladd(v, vec3d_sub(particles->x[i], driven), 1 / h);
        if (particles->w[i] > 0)
            v = vec3d_scale(pushed(v, forces[i], particles->w[i], gravity, h / 2), keep);
        particles->v[i] = v;
    }
}
