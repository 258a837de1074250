/* The moving state of cloth, one entry a physics vertex, and what every solver does with it.
 *
 * Double throughout: in float gravity vanishes for h <= 7e-5 s at 1.5 m. Threads: pure. */
#ifndef TOILE_CLOTH_MESH_PARTICLES_H
#define TOILE_CLOTH_MESH_PARTICLES_H

#include "cloth/mesh/threads.h"
#include "cloth/mesh/vec3d.h"
#include "config/simd.h"

#include <stddef.h>
#include <stdint.h>

struct tl_particles {
    size_t count;    /* the arrays have one more, held, for the empty lanes of batches */
    vec3d *x;        /* m */
    vec3d *previous; /* m, at the start of the substep */
    vec3d *v;        /* m/s */
    double *w;       /* 1/kg; 0: held */
    bool *driven;    /* held by a pin that the avatar carries, and that may push it aside */
};
struct tl_particles tl_particles_create(size_t count);
void tl_particles_release(struct tl_particles *particles);

/* Particles that are moved at once as plain numbers, x, y, z after x, y, z: what these need beside them. */
#define TL_PARTICLE_GROUP 8
TL_INLINE void tl_group_weights(const double *inverse_masses, size_t count,
                                double weights[3 * TL_PARTICLE_GROUP])
{
    for (size_t i = 0; i < count; i++)
        weights[3 * i] = weights[3 * i + 1] = weights[3 * i + 2] = inverse_masses[i];
}

/* `fall` for each y, else 0. The same for all: made once, as what was just written by ones is slow to read by
 * eights. */
TL_INLINE void tl_group_gravity(double gravity_step, double gravity_steps[3 * TL_PARTICLE_GROUP])
{
    for (size_t i = 0; i < TL_PARTICLE_GROUP; i++) {
        gravity_steps[3 * i] = gravity_steps[3 * i + 2] = 0;
        gravity_steps[3 * i + 1] = gravity_step;
    }
}

/* What is done to some of the particles, each by itself. */
struct tl_particle_kernel {
    void (*move)(struct tl_particles *particles, struct tl_range part, const void *params);
    struct tl_particles *particles;
    const void *params;
};
/* On all threads, each for its own part of the particles, denormals off. */
void tl_particles_run(const struct tl_particle_kernel *move);

/* previous <- x, x <- x + h (v exp(-drag h) + h (g + w f)), with `forces` f in N, or none when NULL. What is
 * at rest feels its whole weight, whatever the drag. `v` is left to tl_particles_finish; where that was left
 * out after the substep before, of as many seconds, `moving` takes (x - previous) / h in its place. The move
 * borrows the prediction. */
struct tl_prediction {
    const vec3d *forces;
    double gravity_step, damping_factor, h; /* m/s, share of v that the drag leaves, s */
    bool velocity_from_positions;
};
struct tl_prediction tl_prediction_make(const vec3d *forces, double gravity, double drag, double h);
struct tl_particle_kernel tl_prediction_kernel(struct tl_particles *particles,
                                               const struct tl_prediction *prediction);

/* v <- (x - previous) / h. */
void tl_particles_finish(struct tl_particles *particles, double h);

/* Takes the share `share` of the relative velocity out of every edge, one after the other: the inner friction
 * of the weave, which ends the small quarrels between contact and elastic forces. Keeps the momentum. */
void tl_particles_damp(struct tl_particles *particles, const uint32_t (*edges)[2], size_t edge_count,
                       double share);

/* Denormals cost up to 150 times a normal operation and mean nothing here: flushed to zero while the solver
 * runs. Returns the state to restore. */
unsigned tl_denormals_off(void);
void tl_denormals_restore(unsigned state);

#endif
