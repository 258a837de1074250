/* Where the rays of samples start: on the smooth surface that a triangle stands for, a little above it. And
 * whether the samples are those of the last frame. Part of points.c. */
#ifndef TOILE_RENDER_VISIBILITY_STARTS_H
#define TOILE_RENDER_VISIBILITY_STARTS_H

#include "render/visibility/points.h"

struct tl_starts {
    size_t capacity;
    vec3s *points;    /* [samples], world, metres */
    uint64_t samples; /* a hash of what they start from */
};

void tl_starts_make(const struct tl_points_request *request, struct tl_starts *out);
void tl_starts_release(struct tl_starts *starts);

#endif
