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
    double keep = exp(-drag * h);
    for (size_t i = 0; i < particles->count; i++) {
        double w = particles->w[i];
        vec3d v = {0};
        if (w > 0)
            v = pushed(vec3d_scale(particles->v[i], keep), forces[i], w, gravity, h / 2);
        particles->previous[i] = particles->x[i];
        particles->x[i] = vec3d_muladd(particles->x[i], v, h);
    }
}

void tl_verlet_kick(struct tl_particles *particles, const vec3d *forces, double gravity, double h)
{
    tl_particles_finish(particles, h);
    for (size_t i = 0; i < particles->count; i++)
        if (particles->w[i] > 0)
            particles->v[i] = pushed(particles->v[i], forces[i], particles->w[i], gravity, h / 2);
}
