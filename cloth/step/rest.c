/* The last phase of settling: rest in motion. */
#include "cloth/measure.h"
#include "cloth/step/advance.h"
#include "config/base/log.h"

#include <string.h>

/* Folds are not yet at rest where forces balance: the softest swing for seconds under a force of a hundredth
 * of the weight, and `preview`, in which folds are softer than the cloth's, lets some sink farther. So the
 * last phase is motion, under a drag that stops a swing in about its own period: after a hundred frames a
 * dress of 3,020 vertices stands still, and would else begin to play at 57 mm/s. */
#define REST_DRAG 4 /* 1/s */
#define REST_S    4
/* A swing stands still where it turns. */
#define STILL_FRAMES 10

bool tl_cloth_come_to_rest(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    const struct tl_advance_params advance = {.drag = REST_DRAG};
    struct tl_progress progress = tl_progress_begin("bringing the cloth to rest");
    const double limit = fmin(REST_S, cloth->params.settle_s) * cloth->params.frame_rate;
    bool good = true;
    for (int frame = 0, still = 0; good && frame < limit && still < STILL_FRAMES; frame++) {
        good = tl_cloth_advance(cloth, collider, &advance, error);
        still = tl_cloth_is_still(cloth) ? still + 1 : 0;
        tl_progress_update(&progress, frame + 1, limit);
    }
    tl_progress_end(&progress);
    memset(cloth->particles.v, 0, cloth->particles.count * sizeof *cloth->particles.v);
    return good;
}
