/* The hand that pulls at one particle. It yields: it goes on only as far as it strains no edge there by more
 * than TL_HAND_STRAIN, or than it is strained already, whatever the mesh. Threads: pure. */
#ifndef TOILE_CLOTH_DRIVE_HAND_H
#define TOILE_CLOTH_DRIVE_HAND_H

#include "cloth/energy/pair_forces.h"
#include "cloth/mesh/particles.h"
#include "cloth/solvers/strain_limit.h"

/* What cloth draped on a body does not reach, and a pull should not look like. */
#define TL_HAND_STRAIN 0.5

/* The share of `way` that particle i may be moved by, 0 to 1. */
double tl_hand_share(const struct tl_strain_limits *limits, const struct tl_pair_forces *pairs,
                     const struct tl_particles *particles, uint32_t i, vec3d step);

#endif
