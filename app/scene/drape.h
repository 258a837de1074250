/* The drape of a garment: a cloth that has settled on its wearer, or starts as authored, and has followed it
 * into the first pose of its clip, with its start marked. A drape that was made before, by any process, is
 * taken from the cache (config/cache/cache.h) and steps on as a new one would, to the bit.
 *
 * Threads: one drape at a time per collider; settling uses all. */
#ifndef TOILE_APP_SCENE_DRAPE_H
#define TOILE_APP_SCENE_DRAPE_H

#include "assets/avatar.h"
#include "cloth/cloth.h"

struct tl_drape_request {
    const tl_garment *garment;
    const tl_avatar *avatar; /* NULL: nobody wears it */
    int clip;                /* of the avatar; -1: the rest pose */
    const struct tl_cloth_fabric *fabric;
    const struct tl_cloth_params *params;
    bool settles;     /* false: as authored; the cloth starts at the garment's own positions */
    bool only_sewn;   /* where it settles: no further than until its seams are closed */
    uint64_t options; /* a hash of all options whose rows affect a drape */
    char **inside; /* gets one line about a garment as authored that lies inside its avatar, which the caller
                      frees; else it stays as it is */
};

/* `collider` is new, of the avatar in its rest pose; it is moved into the clip's first pose. Shows progress.
 * NULL: as tl_cloth_settle and tl_cloth_step fail, and TL_INTERRUPTED. The cloth borrows the garment. */
tl_cloth *tl_drape(const struct tl_drape_request *request, tl_collider *collider, tl_error *error);

#endif
