/* A garment of the default fabric at rest on the form, and what that took: of bench cloth and trade cloth.
 * Threads: one drape at a time each. */
#ifndef TOILE_APP_LAB_CLOTH_WORN_H
#define TOILE_APP_LAB_CLOTH_WORN_H

#include "app/measure/cost.h"
#include "assets/avatar.h"
#include "cloth/cloth.h"

struct tl_worn {
    tl_avatar form;
    tl_collider *collider;
    tl_cloth *cloth;
    struct tl_taken taken; /* to come to rest */
};

/* Errors: those of tl_cloth_create and tl_cloth_settle. Lifetime: the garment is borrowed until
 * tl_worn_release, which is called in any case. */
bool tl_worn_settle(const tl_garment *garment, const struct tl_cloth_params *params, struct tl_worn *out,
                    tl_error *error);
void tl_worn_release(struct tl_worn *worn);

#endif
