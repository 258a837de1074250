/* The strain bound of tl_cloth_grab: the pull moves its particle only as far as it strains no edge there by
 * more than TL_HAND_STRAIN, or by more than the edge is strained already, whatever the mesh. Threads: pure.
 */
#ifndef TOILE_CLOTH_DRIVE_HAND_H
#define TOILE_CLOTH_DRIVE_HAND_H

#include "cloth/energy/pair_forces.h"
#include "cloth/mesh/particles.h"
#include "cloth/solvers/strain_limit.h"

/* More than cloth draped on a body reaches. */
#define TL_HAND_STRAIN 0.5

/* The share, 0 to 1, of the displacement `step` that particle i may be moved by. */
double tl_hand_share(const struct tl_strain_limits *limits, const struct tl_pair_forces *pairs,
                     const struct tl_particles *particles, uint32_t i, vec3d step);

#endif
