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
                                 .w = TL_NEW_ARRAY(double, count + 1)};
}

void tl_particles_release(struct tl_particles *particles)
{
    free(particles->x);
    free(particles->previous);
    free(particles->v);
    free(particles->w);
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

struct fall {
    double by, keep, h; /* m/s, share of v that is left, s */
};

static void predict(struct tl_particles *particles, struct tl_range part, const void *how)
{
    const struct fall fall = *(const struct fall *)how;
    for (size_t i = part.from; i < part.to; i++) {
        vec3d x = particles->x[i], v = particles->w[i] > 0 ? particles->v[i] : (vec3d){0};
        if (particles->w[i] > 0)
            v.y -= fall.by;
        v = vec3d_scale(v, fall.keep);
        particles->v[i] = v;
        particles->previous[i] = x;
        particles->x[i] = vec3d_muladd(x, v, fall.h);
    }
}

void tl_particles_predict(struct tl_particles *particles, double gravity, double drag, double h)
{
    const struct fall fall = {gravity * h, exp(-drag * h), h};
    tl_particles_share(particles, predict, &fall);
}

struct push {
    const vec3d *forces;
    double h;
};

static void push(struct tl_particles *particles, struct tl_range part, const void *how)
{
    const struct push by = *(const struct push *)how;
    for (size_t i = part.from; i < part.to; i++)
        particles->v[i] = vec3d_muladd(particles->v[i], by.forces[i], particles->w[i] * by.h);
}

void tl_particles_push(struct tl_particles *particles, const vec3d *forces, double h)
{
    const struct push by = {forces, h};
    tl_particles_share(particles, push, &by);
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
