#include "cloth/xpbd.h"

#include "config/memory.h"

#include <stdlib.h>
#include <string.h>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

/* Shorter than this a vector has no direction to push along. */
#define NO_LENGTH 1e-12

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
                                 .x = TL_NEW_ARRAY(vec3d, count),
                                 .previous = TL_NEW_ARRAY(vec3d, count),
                                 .v = TL_NEW_ARRAY(vec3d, count),
                                 .w = TL_NEW_ARRAY(double, count)};
}

void tl_particles_release(struct tl_particles *particles)
{
    free(particles->x);
    free(particles->previous);
    free(particles->v);
    free(particles->w);
    *particles = (struct tl_particles){0};
}

void tl_xpbd_predict(struct tl_particles *particles, double gravity, double drag, double h)
{
    double keep = exp(-drag * h);
    for (size_t i = 0; i < particles->count; i++) {
        vec3d v = particles->w[i] > 0 ? particles->v[i] : (vec3d){0};
        if (particles->w[i] > 0)
            v.y -= gravity * h;
        particles->v[i] = vec3d_scale(v, keep);
        particles->previous[i] = particles->x[i];
        particles->x[i] = vec3d_muladd(particles->x[i], particles->v[i], h);
    }
}

void tl_xpbd_finish(struct tl_particles *particles, double h)
{
    for (size_t i = 0; i < particles->count; i++)
        particles->v[i] = vec3d_scale(vec3d_sub(particles->x[i], particles->previous[i]), 1 / h);
}

/* What a stretch C = |F| - 1 of gradient row_i F/|F| pushes, in units of F. */
static inline double stretch_push(vec3d f, double factor)
{
    double squared = vec3d_dot(f, f);
    return squared > NO_LENGTH * NO_LENGTH ? factor * (1 - 1 / sqrt(squared)) : 0;
}

/* Both stretches and the shear, one after the other. A push p on row c moves vertex i by w_i c_i p, and so
 * F_u by cc p and F_v by cd p: the three are solved on F alone, and the vertices move once. */
static inline void solve_membrane(const struct tl_membrane *m, struct tl_particles *particles)
{
    vec3d *x[3];
    double w[3];
    for (int i = 0; i < 3; i++) {
        x[i] = &particles->x[m->vertices[i]];
        w[i] = particles->w[m->vertices[i]];
    }
    vec3d u = vec3d_scale(*x[0], m->c[0]), v = vec3d_scale(*x[0], m->d[0]);
    u = vec3d_muladd(vec3d_muladd(u, *x[1], m->c[1]), *x[2], m->c[2]);
    v = vec3d_muladd(vec3d_muladd(v, *x[1], m->d[1]), *x[2], m->d[2]);

    vec3d push_c = vec3d_scale(u, stretch_push(u, m->weft));
    u = vec3d_muladd(u, push_c, m->cc);
    v = vec3d_muladd(v, push_c, m->cd);
    vec3d push_d = vec3d_scale(v, stretch_push(v, m->warp));
    u = vec3d_muladd(u, push_d, m->cd);
    v = vec3d_muladd(v, push_d, m->dd);

    /* C = cosine between the threads, of gradient c_i (v/|v| - C u/|u|)/|u| + d_i (u/|u| - C v/|v|)/|v|. */
    double uu = vec3d_dot(u, u), vv = vec3d_dot(v, v);
    if (uu > NO_LENGTH * NO_LENGTH && vv > NO_LENGTH * NO_LENGTH) {
        double both = 1 / sqrt(uu * vv), cosine = vec3d_dot(u, v) * both;
        vec3d along_u = vec3d_muladd(vec3d_scale(v, both), u, -cosine / uu);
        vec3d along_v = vec3d_muladd(vec3d_scale(u, both), v, -cosine / vv);
        double gradient = m->cc * vec3d_dot(along_u, along_u) + 2 * m->cd * vec3d_dot(along_u, along_v) +
                          m->dd * vec3d_dot(along_v, along_v);
        double sum = gradient + m->shear, multiplier = sum > 0 ? -cosine / sum : 0;
        push_c = vec3d_muladd(push_c, along_u, multiplier);
        push_d = vec3d_muladd(push_d, along_v, multiplier);
    }
    for (int i = 0; i < 3; i++)
        *x[i] = vec3d_muladd(vec3d_muladd(*x[i], push_c, w[i] * m->c[i]), push_d, w[i] * m->d[i]);
}

/* The three components of the curvature: vectors, linear in the positions. */
static inline void solve_bend(const struct tl_bend *bend, struct tl_particles *particles)
{
    vec3d x[TL_BEND_STENCIL];
    double w[TL_BEND_STENCIL];
    for (int i = 0; i < TL_BEND_STENCIL; i++) {
        x[i] = particles->x[bend->vertices[i]];
        w[i] = particles->w[bend->vertices[i]];
    }
    for (int row = 0; row < 3; row++) {
        const double *r = bend->rows[row];
        vec3d curvature = vec3d_scale(x[0], r[0]);
        for (int i = 1; i < TL_BEND_STENCIL; i++)
            curvature = vec3d_muladd(curvature, x[i], r[i]);
        vec3d push = vec3d_scale(curvature, bend->factors[row]);
        for (int i = 0; i < TL_BEND_STENCIL; i++)
            x[i] = vec3d_muladd(x[i], push, w[i] * r[i]);
    }
    for (int i = TL_BEND_STENCIL - 1; i >= 0; i--) /* last the first: it stands in for missing ones */
        particles->x[bend->vertices[i]] = x[i];
}

void tl_xpbd_solve_link(const struct tl_link *link, struct tl_particles *particles)
{
    double wa = particles->w[link->a], wb = particles->w[link->b];
    vec3d apart = vec3d_sub(particles->x[link->b], particles->x[link->a]);
    double length = vec3d_norm(apart), sum = wa + wb + link->compliance;
    if (length < NO_LENGTH || !(wa + wb > 0) || !isfinite(sum))
        return;
    vec3d push = vec3d_scale(apart, (length - link->rest) / (length * sum));
    particles->x[link->a] = vec3d_muladd(particles->x[link->a], push, wa);
    particles->x[link->b] = vec3d_muladd(particles->x[link->b], push, -wb);
}

void tl_xpbd_solve(const struct tl_energy *energy, struct tl_particles *particles)
{
    for (size_t i = 0; i < energy->membrane_count; i++)
        solve_membrane(&energy->membranes[i], particles);
    for (size_t i = 0; i < energy->bend_count; i++)
        solve_bend(&energy->bends[i], particles);
    for (size_t i = 0; i < energy->link_count; i++)
        tl_xpbd_solve_link(&energy->links[i], particles);
}
