/* Numbers read from the state of a cloth: speed, strain, energies. SI. Threads: pure. */
#ifndef TOILE_CLOTH_MEASURE_H
#define TOILE_CLOTH_MEASURE_H

#include "cloth/state.h"

/* Sums over the particles that are not held. */
struct tl_energies {
    double kinetic, elastic, potential; /* J */
    double mass;                        /* kg */
};
struct tl_energies tl_cloth_energies(const tl_cloth *cloth);

/* Speed of the fastest free particle, m/s. */
double tl_cloth_max_speed(const tl_cloth *cloth);

/* Root mean square distance of the particles from `from` [particles.count], m. */
double tl_cloth_moved_from(const tl_cloth *cloth, const vec3d *from);

/* Largest strain of a triangle's side, as struct tl_cloth_report defines it. */
double tl_cloth_max_strain(const tl_cloth *cloth);

#endif
