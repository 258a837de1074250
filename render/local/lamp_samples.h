/* Light of lamps on samples, and what surfaces emit at samples, that the camera does not see directly: behind
 * open cloth, on the other side of translucent cloth, and in near mirrors. These samples exist on the CPU
 * only, so they are shaded here, exactly, with a shadow ray each. Pure; OpenMP inside; results do not depend
 * on the number of threads. */
#ifndef TOILE_RENDER_LOCAL_LAMP_SAMPLES_H
#define TOILE_RENDER_LOCAL_LAMP_SAMPLES_H

#include "render/light/mirrors.h"
#include "render/local/lamp_rays.h"

struct tl_lamp_samples_request {
    const struct tl_lamp *lamps;
    size_t lamp_count;
    bool shadowed; /* false: no rays are traced */
    const tl_trace *trace;
    const struct tl_samples *samples;
    const float *shares;             /* by sample that is seen, as light/compose.h; NULL: their cover */
    const struct tl_mirror *mirrors; /* by sample; NULL: none */
    const struct tl_triangle_ranges *ranges;
    const struct tl_ground *ground; /* NULL: none */
    vec3s eye;
};

/* Adds to light[height][width][4], premultiplied. The samples [0, primary_count) only get what their mirrors
 * reflect. */
void tl_lamp_samples_add(const struct tl_lamp_samples_request *request, float *light);

#endif
