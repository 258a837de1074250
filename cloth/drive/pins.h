/* Pins: vertices that are held. A pin within reach of the avatar rides on its nearest triangle; one that
 * starts inside is held just outside. A part of the avatar that sweeps over a riding pin moves it
 * (contact/contact.h). Other pins stay where they are. Metres. Threads: pure. */
#ifndef TOILE_CLOTH_DRIVE_PINS_H
#define TOILE_CLOTH_DRIVE_PINS_H

#include "cloth/contact/collider.h"
#include "cloth/mesh/particles.h"

struct tl_pin {
    uint32_t particle;
    bool by_hand;      /* by tl_cloth_pin */
    bool bound;        /* the search for a triangle has been done */
    vec3d at;          /* position of a pin that does not ride */
    uint32_t triangle; /* of the avatar; TL_NONE: none */
    double barycentric[3];
    vec3d offset; /* from the triangle's point, in the triangle's own axes */
};

/* Binds pins that are not bound yet to the nearest triangle of the collider's previous pose, if one is near.
 */
void tl_pins_bind(struct tl_pin *pins, size_t count, const tl_collider *collider, double thickness_m);

/* Puts the particles where the pins are at a phase of the collider's motion. */
void tl_pins_place(const struct tl_pin *pins, size_t count, const tl_collider *collider, double phase,
                   struct tl_particles *particles);

#endif
