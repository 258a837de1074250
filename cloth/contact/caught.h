/* Cloth that two parts of the avatar have caught between them and drag along, an arm over a hip say.
 *
 * No particle may be inside, so what is caught can only stretch. Beyond a multiple of its length it slips
 * free instead of tearing: its edges are drawn short again in one go, whatever is in the way, and the
 * particles that moved look for the outside anew from there. Threads: pure. */
#ifndef TOILE_CLOTH_CONTACT_CAUGHT_H
#define TOILE_CLOTH_CONTACT_CAUGHT_H

#include "cloth/mesh/particles.h"
#include "cloth/mesh/topology.h"

#include <cglm/struct.h>

/* Strained beyond this an edge is caught: no fabric is worn like that. */
#define TL_CAUGHT_STRAIN 1.5

/* Flags in `slipped` [particles->count] those that did, and stops them; leaves other flags as they are.
 * `rest` gives the flat rest shape of every triangle; edges shorter than `shortest` metres are let be. */
void tl_caught_release(const struct tl_topology *topology, const vec2s (*rest)[3], double shortest,
                       struct tl_particles *particles, bool *slipped);

#endif
