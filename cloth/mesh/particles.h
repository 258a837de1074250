/* The moving state of the cloth, one entry per physics vertex, and the loops over it that the solvers share.
 *
 * Double precision throughout: in float, the position increment h^2 g of a particle at 1.5 m is rounded away
 * for h <= 7e-5 s. Lifetime: plain structs that own their arrays unless stated otherwise. Threads: pure. */
#ifndef TOILE_CLOTH_MESH_PARTICLES_H
#define TOILE_CLOTH_MESH_PARTICLES_H

#include "cloth/mesh/team.h"
#include "cloth/mesh/vec3d.h"
#include "config/base/simd.h"

#include <stddef.h>
#include <stdint.h>

struct tl_particles {
    size_t count;    /* the arrays have one more entry, held, which stands in the empty lanes of batches */
    vec3d *x;        /* m */
    vec3d *previous; /* m, at the start of the substep */
    vec3d *v;        /* m/s */
    double *w;       /* 1/kg; 0: held */
    bool *driven;    /* held by a pin that rides on the avatar: contact may still move it */
};
struct tl_particles tl_particles_create(size_t count);
void tl_particles_release(struct tl_particles *particles);

/* Particles are processed in groups whose coordinates are read as one array x y z x y z ..., which vectorises
 * without shuffles; per-particle numbers are expanded to match. Expands inverse masses. */
#define TL_PARTICLE_GROUP 8
TL_INLINE void tl_group_weights(const double *inverse_masses, size_t count,
                                double weights[3 * TL_PARTICLE_GROUP])
{
    for (size_t i = 0; i < count; i++)
        weights[3 * i] = weights[3 * i + 1] = weights[3 * i + 2] = inverse_masses[i];
}

/* Expands gravity: `gravity_step` for each y, else 0. It is the same for all groups and so made once: reading
 * by wide loads what narrow stores have just written stalls. */
TL_INLINE void tl_group_gravity(double gravity_step, double gravity_steps[3 * TL_PARTICLE_GROUP])
{
    for (size_t i = 0; i < TL_PARTICLE_GROUP; i++) {
        gravity_steps[3 * i] = gravity_steps[3 * i + 2] = 0;
        gravity_steps[3 * i + 1] = gravity_step;
    }
}

/* A loop body over a range of particles, each of which it treats on its own. */
struct tl_particle_kernel {
    void (*run)(struct tl_particles *particles, struct tl_range part, const void *params);
    struct tl_particles *particles;
    const void *params;
};
/* Runs a kernel on all threads, each on its own range of the particles, with denormals flushed to zero. */
void tl_particles_run(const struct tl_particle_kernel *kernel);

/* The prediction of `preview`:
 *     previous <- x,   x <- x + h (v exp(-drag h) + h (g + w f)),
 * with `forces` f in N, or none if NULL. Drag scales the velocity only, so that cloth at rest feels its whole
 * weight whatever the drag. Velocities are written by tl_particles_finish; if that was skipped after the
 * substep before (of the same length), `velocity_from_positions` uses (x - previous) / h instead of v. */
struct tl_prediction {
    const vec3d *forces;
    double gravity_step, damping_factor, h; /* m/s, share of v that the drag leaves, s */
    bool velocity_from_positions;
};
struct tl_prediction tl_prediction_make(const vec3d *forces, double gravity, double drag, double h);
/* Borrows both arguments. */
struct tl_particle_kernel tl_prediction_kernel(struct tl_particles *particles,
                                               const struct tl_prediction *prediction);

/* Velocities from displacements: v <- (x - previous) / h. */
void tl_particles_finish(struct tl_particles *particles, double h);

/* Removes the share `share` of the relative velocity of every edge's ends, edge after edge: the weave's inner
 * friction. Without it, small oscillations between contact and elastic forces never die. Conserves momentum.
 */
void tl_particles_damp(struct tl_particles *particles, const uint32_t (*edges)[2], size_t edge_count,
                       double share);

#endif
