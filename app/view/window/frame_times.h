/* How long frames took: the last ones for a strip, and a distribution of all of them that needs no more
 * memory however long the window is open. Pure. Milliseconds. */
#ifndef TOILE_APP_VIEW_WINDOW_FRAME_TIMES_H
#define TOILE_APP_VIEW_WINDOW_FRAME_TIMES_H

#include <stddef.h>

#define TL_FRAME_TIMES_SHOWN 120
#define TL_FRAME_TIMES_BINS  2048 /* each 1 % wider than the one before, from 0.01 ms: up to two hours */

struct tl_frame_times {
    float last[TL_FRAME_TIMES_SHOWN]; /* a ring */
    size_t first, count;              /* of the ring */
    size_t bins[TL_FRAME_TIMES_BINS];
    size_t total;
    double worst_ms;
};

void tl_frame_times_add(struct tl_frame_times *times, double ms);
/* The i-th of the `count` last ones, the oldest first. */
float tl_frame_times_at(const struct tl_frame_times *times, size_t i);
/* What `share` of all frames stayed within, to 1 %; 0 when there are none. */
double tl_frame_times_quantile(const struct tl_frame_times *times, double share);

#endif
