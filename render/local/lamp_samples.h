/* Lamplight of what the camera does not see at first: behind open cloth, on the other side of cloth that
 * scatters light through, and in near mirrors. These samples exist on the CPU only (light/transparency.h,
 * light/mirrors.h), so they are lit here, exactly, with a shadow ray each. Pure; OpenMP inside; results do
 * not depend on the number of threads. */
#ifndef TOILE_RENDER_LOCAL_LAMP_SAMPLES_H
#define TOILE_RENDER_LOCAL_LAMP_SAMPLES_H

#include "render/light/mirrors.h"
#include "render/local/lamp_rays.h"

struct tl_lamp_samples_request {
    const struct tl_lamp *lamps;
    size_t lamp_count;
    bool shadowed; /* else no ray is asked */
    const tl_trace *trace;
    const struct tl_samples *samples;
    const float *shares;             /* by sample that is seen, as light/compose.h; NULL: their cover */
    const struct tl_mirror *mirrors; /* by sample; NULL: none */
    const struct tl_triangle_ranges *ranges;
    const struct tl_ground *ground; /* NULL: none */
    vec3s eye;
};

/* Adds to light[height][width][4], premultiplied. Of samples [0, primary_count) only what their mirrors show.
 */
void tl_lamp_samples_add(const struct tl_lamp_samples_request *request, float *light);

#endif
