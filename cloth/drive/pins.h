/* Held vertices. A pin within reach of the avatar rides on its nearest triangle; one that starts inside of it
 * is held just outside, and a part of the avatar that sweeps over it sets it aside (cloth/contact/contact.h).
 * Others stay where they are. Metres. Threads: pure. */
#ifndef TOILE_CLOTH_DRIVE_PINS_H
#define TOILE_CLOTH_DRIVE_PINS_H

#include "cloth/contact/collider.h"
#include "cloth/mesh/particles.h"

struct tl_pin {
    uint32_t particle;
    bool by_hand;      /* by tl_cloth_pin */
    bool bound;        /* the avatar has been looked for */
    vec3d at;          /* where it is held, when nothing carries it */
    uint32_t triangle; /* of the avatar; TL_NONE: none */
    double barycentric[3];
    vec3d offset; /* from the triangle's point, in the triangle's own axes */
};

/* Looks for a carrier for those that have not looked yet, in the collider's previous pose. */
void tl_pins_bind(struct tl_pin *pins, size_t count, const tl_collider *collider, double thickness_m);

/* Puts the particles where the pins are at a phase of the collider's motion. */
void tl_pins_place(const struct tl_pin *pins, size_t count, const tl_collider *collider, double phase,
                   struct tl_particles *particles);

#endif
