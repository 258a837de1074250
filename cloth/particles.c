#include "cloth/particles.h"

#include "cloth/threads.h"
#include "config/memory.h"

#include <stdlib.h>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

unsigned tl_denormals_off(void)
{
#ifdef __SSE2__
    unsigned state = _mm_getcsr();
    _mm_setcsr(state | 0x8040); /* FTZ | DAZ */
    return state;
#else
    return 0;
#endif
}

void tl_denormals_restore(unsigned state)
{
#ifdef __SSE2__
    _mm_setcsr(state);
#else
    (void)state;
#endif
}

struct tl_particles tl_particles_create(size_t count)
{
    return (struct tl_particles){.count = count,
                                 .x = TL_NEW_ARRAY(vec3d, count + 1),
                                 .previous = TL_NEW_ARRAY(vec3d, count + 1),
                                 .v = TL_NEW_ARRAY(vec3d, count + 1),
                                 .w = TL_NEW_ARRAY(double, count + 1),
                                 .driven = TL_NEW_ARRAY(bool, count + 1)};
}

void tl_particles_release(struct tl_particles *particles)
{
    free(particles->x);
    free(particles->previous);
    free(particles->v);
    free(particles->w);
    free(particles->driven);
    *particles = (struct tl_particles){0};
}

void tl_particles_share(struct tl_particles *particles, tl_particles_mover *move, const void *how)
{
#pragma omp parallel if (particles->count >= TL_PARALLEL_VERTICES)
    {
        unsigned denormals = tl_denormals_off();
        move(particles, tl_my_part(particles->count, 1), how);
        tl_denormals_restore(denormals);
    }
}

struct prediction {
    const vec3d *forces;  /* or NULL */
    double fall, keep, h; /* m/s, share of v that the drag leaves, s */
};

static void predict(struct tl_particles *particles, struct tl_range part, const void *how)
{
    const struct prediction to = *(const struct prediction *)how;
    for (size_t i = part.from; i < part.to; i++) {
        double w = particles->w[i];
        vec3d x = particles->x[i], v = w > 0 ? vec3d_scale(particles->v[i], to.keep) : (vec3d){0};
        if (w > 0)
            v.y -= to.fall;
        if (to.forces)
            v = vec3d_muladd(v, to.forces[i], w * to.h);
        particles->v[i] = v;
        particles->previous[i] = x;
        particles->x[i] = vec3d_muladd(x, v, to.h);
    }
}

void tl_particles_predict(struct tl_particles *particles, const vec3d *forces, double gravity, double drag,
                          double h)
{
    const struct prediction to = {forces, gravity * h, exp(-drag * h), h};
    tl_particles_share(particles, predict, &to);
}

static void finish(struct tl_particles *particles, struct tl_range part, const void *how)
{
    double per_h = 1 / *(const double *)how;
    for (size_t i = part.from; i < part.to; i++)
        particles->v[i] = vec3d_scale(vec3d_sub(particles->x[i], particles->previous[i]), per_h);
}

void tl_particles_finish(struct tl_particles *particles, double h)
{
    tl_particles_share(particles, finish, &h);
}

void tl_particles_calm(struct tl_particles *particles, const uint32_t (*edges)[2], size_t edge_count,
                       double share)
{
    for (size_t i = 0; i < edge_count; i++) {
        uint32_t a = edges[i][0], b = edges[i][1];
        double sum = particles->w[a] + particles->w[b];
        if (!(sum > 0))
            continue;
        vec3d impulse = vec3d_scale(vec3d_sub(particles->v[b], particles->v[a]), share / sum);
        particles->v[a] = vec3d_muladd(particles->v[a], impulse, particles->w[a]);
        particles->v[b] = vec3d_muladd(particles->v[b], impulse, -particles->w[b]);
    }
}
