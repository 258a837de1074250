/* Contact of a cloth with the avatar, the ground and itself, with the cloth's own thickness and friction.
 *
 * Before a substep the caller looks for what the cloth might touch (tl_cloth_renew_contact); after the other
 * constraints of the substep it keeps the cloth apart (tl_cloth_solve_contact); after a step of several
 * substeps it moves outside what these have left inside (tl_cloth_keep_outside). SI. Errors: none but where
 * stated. Threads: one call at a time for one cloth. */
#ifndef TOILE_CLOTH_CONTACTS_H
#define TOILE_CLOTH_CONTACTS_H

#include "cloth/state.h"

/* Contact with the avatar in a substep of h seconds. While seams close there is no friction. */
struct tl_contact_params tl_cloth_contact_params(const tl_cloth *cloth, double h, double phase_before,
                                                 double phase);

/* Whether the garment came crossed and has not come apart yet: its layers, which know what is inside and what
 * outside, then help. */
bool tl_cloth_is_tangled(const tl_cloth *cloth);

/* Orders the layers of a tangled garment once the panels have met: until then each panel is a piece of its
 * own. Errors: those of tl_layers_decide. */
bool tl_cloth_order_layers(tl_cloth *cloth, const tl_collider *collider, tl_error *error);

/* Prepares self-contact for the mesh, where that is not done yet. */
void tl_cloth_prepare_contact(tl_cloth *cloth);

/* Searches for what the cloth might touch in a substep of h seconds, if what is known is outdated. Velocities
 * are (x - previous) / h if `velocity_from_positions`, else v. */
void tl_cloth_renew_contact(tl_cloth *cloth, double h, double phase_before, bool velocity_from_positions);

/* Contact of the cloth with itself, then with the avatar; last, what would pass through the cloth is moved
 * back. */
void tl_cloth_solve_contact(tl_cloth *cloth, const struct tl_contact_params *contact);

/* Moves cloth outside that a step has left inside the avatar, and keeps it on its side of other cloth. Where
 * it cannot be both, as between an arm and a hip that pass through each other, the avatar lets it go.
 * `contact` is of the whole step. */
void tl_cloth_keep_outside(tl_cloth *cloth, const tl_collider *collider,
                           const struct tl_contact_params *contact);

/* Finds what touches the cloth where it is now, by searches of its own: the planes of `body` and contacts of
 * `self`, which stays {0} where the cloth passes through itself. End with tl_contacts_release and
 * tl_self_contact_release. Borrows the cloth and the collider. */
void tl_cloth_find_contacts(const tl_cloth *cloth, const tl_collider *collider, struct tl_contacts *body,
                            struct tl_self_contact *self);

#endif
