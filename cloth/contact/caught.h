/* Cloth that is caught between two parts of the moving avatar and dragged along, for example by an arm over a
 * hip.
 *
 * No particle may be inside the avatar, so caught cloth can only stretch. Beyond a bound it slips free
 * instead: its edges are shortened at once, whatever is in the way, and contact then moves the particles
 * outside from where they are. Threads: pure. */
#ifndef TOILE_CLOTH_CONTACT_CAUGHT_H
#define TOILE_CLOTH_CONTACT_CAUGHT_H

#include "cloth/mesh/particles.h"
#include "cloth/mesh/topology.h"

#include <cglm/struct.h>

/* An edge of larger strain is caught: no fabric is worn like that. */
#define TL_CAUGHT_STRAIN 1.5

/* Releases caught edges. Stops the particles that moved and sets their flags in `slipped` [particles->count];
 * other flags keep their value. `rest` are the rest shapes of all triangles; edges shorter than `shortest`
 * metres are ignored. */
void tl_caught_release(const struct tl_topology *topology, const vec2s (*rest)[3], double shortest,
                       struct tl_particles *particles, bool *slipped);

/* Whether an edge is three times as long as at rest: other cloth has kept it from slipping free. */
bool tl_caught_tears(const struct tl_topology *topology, const vec2s (*rest)[3], double shortest,
                     const vec3d *x);

#endif
