/* Exchange of single planes within a window (self_contact.h).
 *
 * Planes stand still, and two features that move on together are stopped by the plane between them. A pair's
 * plane may be exchanged for another at the start of any substep: both hold the pair's vertices there, and
 * the new one holds from then on. So only the pairs that stop a vertex are looked at again, and not the whole
 * cloth.
 *
 * A pair that even so stops a vertex gets a plane that moves: within one substep each vertex goes a straight
 * way, and so may each plane; what is on its side at the start and at the end is there at all times between.
 */
#ifndef TOILE_CLOTH_SELF_CONTACT_EXCHANGE_H
#define TOILE_CLOTH_SELF_CONTACT_EXCHANGE_H

#include "cloth/self_contact/self_contact.h"

/* Exchanges planes so that the vertices that self->cut marks can go where they want, `x`, as far as their
 * pairs leave them place; moves them, and other vertices of these pairs, to where they then can be. `start`
 * is where all planes hold. Returns whether a vertex was moved into the body. Metres. Errors: none. Threads:
 * one call at a time. */
bool tl_self_contact_exchange(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                              const struct tl_self_contact_start *start, vec3d *x);

#endif
