/* Frame times: the last ones for a strip, and a histogram of all, of constant size. Pure. Milliseconds. */
#ifndef TOILE_APP_VIEW_WINDOW_FRAME_TIMES_H
#define TOILE_APP_VIEW_WINDOW_FRAME_TIMES_H

#include <stddef.h>

#define TL_FRAME_TIMES_SHOWN 120
#define TL_FRAME_TIMES_BINS                                                                                  \
    2048 /* the first ends at 0.01 ms, each further one is 1 % wider: up to two hours */

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
/* The quantile at `share` of all frames, to 1 %; 0 when there are none. */
double tl_frame_times_quantile(const struct tl_frame_times *times, double share);

#endif
