#include "cloth/mesh/particles.h"

#include "cloth/mesh/team.h"
#include "config/base/memory.h"

#include <stdlib.h>

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

static void run_on_team(void *context)
{
    const struct tl_particle_kernel *kernel = context;
    kernel->run(kernel->particles, tl_team_range(kernel->particles->count, 1), kernel->params);
}

void tl_particles_run(const struct tl_particle_kernel *kernel)
{
    struct tl_particle_kernel on_team = *kernel;
    tl_team_run(kernel->particles->count, run_on_team, &on_team);
}

struct tl_prediction tl_prediction_make(const vec3d *forces, double gravity, double drag, double h)
{
    return (struct tl_prediction){
        .forces = forces, .gravity_step = gravity * h, .damping_factor = exp(-drag * h), .h = h};
}

TL_INLINE void predict_group(struct tl_particles *particles, size_t first, size_t count,
                             const struct tl_prediction *to,
                             const double gravity_steps[3 * TL_PARTICLE_GROUP], bool pushed,
                             bool velocity_from_positions)
{
    const double h = to->h, per_h = 1 / h, damping_factor = to->damping_factor;
    double weights[3 * TL_PARTICLE_GROUP];
    tl_group_weights(&particles->w[first], count, weights);
    double *restrict x = &particles->x[first].x, *restrict previous = &particles->previous[first].x;
    const double *restrict v = &particles->v[first].x;
    const double *restrict forces = pushed ? &to->forces[first].x : v;
    for (size_t k = 0; k < 3 * count; k++) {
        double speed = velocity_from_positions ? (x[k] - previous[k]) * per_h : v[k];
        speed = weights[k] > 0 ? speed * damping_factor - gravity_steps[k] : 0;
        if (pushed)
            speed += forces[k] * (weights[k] * h);
        previous[k] = x[k];
        x[k] += speed * h;
    }
}

TL_CLONES static void predict(struct tl_particles *particles, struct tl_range part, const void *params)
{
    const struct tl_prediction to = *(const struct tl_prediction *)params;
    double gravity_steps[3 * TL_PARTICLE_GROUP];
    tl_group_gravity(to.gravity_step, gravity_steps);
    size_t i = part.from;
    for (; i + TL_PARTICLE_GROUP <= part.to && to.forces && to.velocity_from_positions;
         i += TL_PARTICLE_GROUP) /* the usual case, as constants */
        predict_group(particles, i, TL_PARTICLE_GROUP, &to, gravity_steps, true, true);
    for (; i < part.to; i++)
        predict_group(particles, i, 1, &to, gravity_steps, to.forces, to.velocity_from_positions);
}

struct tl_particle_kernel tl_prediction_kernel(struct tl_particles *particles,
                                               const struct tl_prediction *prediction)
{
    return (struct tl_particle_kernel){predict, particles, prediction};
}

static void finish(struct tl_particles *particles, struct tl_range part, const void *params)
{
    double per_h = 1 / *(const double *)params;
    for (size_t i = part.from; i < part.to; i++)
        particles->v[i] = vec3d_scale(vec3d_sub(particles->x[i], particles->previous[i]), per_h);
}

void tl_particles_finish(struct tl_particles *particles, double h)
{
    tl_particles_run(&(const struct tl_particle_kernel){finish, particles, &h});
}

void tl_particles_damp(struct tl_particles *particles, const uint32_t (*edges)[2], size_t edge_count,
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
