/* Corrects the visibility that samples interpolate from points, in two ways. Part of points.c.
 *
 * Extra points: interpolation fails in triangles whose corners differ most, so their samples get points of
 * their own. Nearly all of the error is in one pixel of a hundred, where folds touch and where cloth lies on
 * a body. In motion these points are traced again every frame; at rest they are averaged, and there may be
 * more of them.
 *
 * Cover: at the border of cloth that lies on a body, a triangle has open corners and covered ones.
 * Interpolation would make everything between them half dark. A covered sample therefore reads only the
 * covered corners, and an open sample only the open ones. */
#ifndef TOILE_RENDER_VISIBILITY_REPAIR_H
#define TOILE_RENDER_VISIBILITY_REPAIR_H

#include "render/visibility/ray_origins.h"
#include "render/visibility/refresh.h"

struct tl_repair {
    size_t capacity, count;
    uint32_t *samples; /* [count]: rising */
    int rounds;    /* in the mean */
    size_t next;   /* bundle of samples at which the current round continues */
    bool at_rest;  /* chosen when nothing moved */
};

/* Chooses the `wanted` samples with the largest doubt, fewer if fewer have any. `taps` are those of the
 * triangles' corners. */
void tl_repair_choose(struct tl_repair *repair, const struct tl_refresh *refresh, const struct tl_taps *taps,
                      const uint16_t *values, size_t wanted);

/* Continues a round with up to `bundles` of TL_CLUSTER samples, into `values` and `weights`
 * [count][stride]. Returns the number of rays. */
size_t tl_repair_trace(struct tl_repair *repair, const struct tl_refresh *refresh,
                       const struct tl_ray_origins *origins, size_t bundles, uint16_t *values,
                       uint16_t *weights);
void tl_repair_release(struct tl_repair *repair);
size_t tl_repair_bytes(const struct tl_repair *repair);

/* Restricts each sample's taps to the corners that are covered as the sample is, and normalises their
 * weights. Bit i of covered[c] is set where a surface lies close above point c x TL_CLUSTER + i. */
void tl_taps_match_cover(const struct tl_points_request *request, const uint16_t *covered,
                         struct tl_taps *taps);

#endif
