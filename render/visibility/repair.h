/* Points of samples' own, for the few whose triangle's corners disagree most: what lies between them would be
 * guessed (FRONTIER: nearly all of the error sits in one pixel of a hundred, where folds and cloth on a body
 * touch). Made anew in every moving frame, averaged at rest, where there may be more of them. Part of
 * points.c. */
#ifndef TOILE_RENDER_VISIBILITY_REPAIR_H
#define TOILE_RENDER_VISIBILITY_REPAIR_H

#include "render/visibility/ray_origins.h"
#include "render/visibility/refresh.h"

struct tl_repair {
    size_t capacity, count;
    uint32_t *samples; /* [count]: rising */
    size_t doubt_capacity;
    float *doubts; /* by sample: how much light its corners disagree about */
    int rounds;    /* in the mean */
    size_t next;   /* bundle of samples with which the round under way goes on */
    bool at_rest;  /* chosen when nothing moved */
};

/* Chooses the `wanted` most doubtful samples, fewer when fewer are in doubt. `taps` are of the triangles'
 * corners. */
void tl_repair_choose(struct tl_repair *repair, const struct tl_refresh *refresh, const struct tl_taps *taps,
                      const uint16_t *values, size_t wanted);

/* Goes on with a round by up to `bundles` of TL_CLUSTER samples, into `values` and `weights`
 * [count][stride]. Returns the number of rays. */
size_t tl_repair_trace(struct tl_repair *repair, const struct tl_refresh *refresh,
                       const struct tl_ray_origins *origins, size_t bundles, uint16_t *values,
                       uint16_t *weights);
void tl_repair_release(struct tl_repair *repair);
size_t tl_repair_bytes(const struct tl_repair *repair);

#endif
