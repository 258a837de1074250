/* Self-repulsion: particles that are nearer than the thickness push each other apart, with Coulomb friction.
 * That keeps folds apart, which is enough to review a drape; an edge may still pass between the particles of
 * a coarse mesh. Pairs that start nearer than the thickness keep their start distance instead. Pairs are
 * found by a spatial hash (Teschner et al. 2003), once a step, in a fixed order. Metres. Lifetime: plain
 * struct that owns its array. Threads: pure. */
#ifndef TOILE_CLOTH_CONTACT_REPULSION_H
#define TOILE_CLOTH_CONTACT_REPULSION_H

#include "cloth/mesh/particles.h"

struct tl_repulsion_pair {
    uint32_t a, b;
    double distance_m; /* kept */
};

struct tl_repulsion {
    size_t pair_count, pair_capacity;
    struct tl_repulsion_pair *pairs; /* good for one step */
};
void tl_repulsion_release(struct tl_repulsion *repulsion);

/* Finds the pairs; once per step, at its start. `start` [count] are the positions in the garment's file. */
void tl_repulsion_update(struct tl_repulsion *repulsion, size_t count, const vec3d *x, const vec3d *start,
                         double thickness_m);

/* Pushes the pairs apart; once per substep of h seconds. */
void tl_repulsion_solve(const struct tl_repulsion *repulsion, double friction, double h,
                        struct tl_particles *particles);

#endif
