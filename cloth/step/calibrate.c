#include "cloth/step/calibrate.h"

#include "cloth/contacts.h"
#include "cloth/mesh/denormals.h"
#include "cloth/solvers/xpbd.h"
#include "cloth/step/advance.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define ROUNDS 60
/* Share of what is missing that a round adds. */
#define GAIN 0.6
/* The largest shift of a rest strain. */
#define SHIFT_MAX 0.3

void tl_cloth_calibrate(tl_cloth *cloth, const tl_collider *collider)
{
    struct tl_particles *particles = &cloth->particles;
    const size_t count = particles->count;
    if (cloth->params.solver != TL_CLOTH_PREVIEW)
        return;
    unsigned denormals = tl_denormals_off();
    vec3d *held = TL_NEW_ARRAY(vec3d, count);
    double(*applied)[3][TL_BATCH] = tl_alloc(cloth->energy.membrane_count, sizeof *applied);
    memcpy(held, particles->x, count * sizeof *held);
    tl_xpbd_reset_rest(&cloth->energy);
    tl_cloth_prepare_contact(cloth);
    tl_contacts_begin(&cloth->contacts, collider);
    tl_contacts_update(&cloth->contacts, held, cloth->fabric.thickness_m, 1);
    for (int round = 0; round < ROUNDS; round++) {
        memset(particles->v, 0, count * sizeof *particles->v);
        tl_apart_end_window(&cloth->apart);
        tl_cloth_preview_substep(cloth, collider, applied);
        memcpy(particles->x, held, count * sizeof *held);
        tl_xpbd_shift_rest(&cloth->energy, held, (const double(*)[3][TL_BATCH])applied, GAIN, SHIFT_MAX);
    }
    memset(particles->v, 0, count * sizeof *particles->v);
    tl_apart_end_window(&cloth->apart);
    free(held);
    free(applied);
    tl_denormals_restore(denormals);
}
