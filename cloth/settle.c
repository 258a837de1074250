/* Coming to rest before the first frame. */
#include "cloth/state.h"
#include "config/log.h"

#include <string.h>

/* Drag while settling: a fall ends at 2 m/s, a swing of 0.5 m dies within a period. */
#define SETTLE_DRAG 5.0
/* A cloth that starts at rest has no speed either: it is given this long to begin to fall. */
#define LEAST_S 0.25

bool tl_cloth_settle(tl_cloth *cloth, const tl_collider *collider, tl_error *error)
{
    const struct tl_advance advance = {.drag = SETTLE_DRAG};
    const struct tl_cloth_params *params = &cloth->params;
    struct tl_progress progress = tl_progress_begin("settling the cloth");
    double frame_s = 1 / params->frame_rate, hung_s = 0;
    bool good = true;
    cloth->settled = false;
    while (good && !cloth->settled && hung_s < params->settle_s) {
        good = tl_cloth_advance(cloth, collider, &advance, error);
        if (!tl_sewing_pulls(&cloth->sewing))
            hung_s += frame_s;
        cloth->settled = good && hung_s > LEAST_S && tl_cloth_max_speed(cloth) < params->settle_speed;
        tl_progress_update(&progress, hung_s, params->settle_s);
    }
    tl_progress_end(&progress);
    if (good && !cloth->settled && params->settle_s > 0)
        tl_info("the cloth still moves at %.3f m/s after settling for %g s: give it more with cloth.settle_s",
                tl_cloth_max_speed(cloth), params->settle_s);
    memset(cloth->particles.v, 0, cloth->particles.count * sizeof(vec3d));
    return good;
}
