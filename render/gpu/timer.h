/* Times of the parts of a frame. On hardware GL stamps the time at each mark, nothing waits, and the times of
 * a frame are read when they are there, some frames later. Where GL is software its stamps are of when work
 * was queued (clocks.h): there each mark waits for the work and takes the CPU's clock, and a frame's times
 * are there when it ends. One thread: that of the context. */
#ifndef TOILE_RENDER_GPU_TIMER_H
#define TOILE_RENDER_GPU_TIMER_H

#include <stdbool.h>
#include <stdint.h>

#define TL_TIMER_MARKS_MAX 64 /* of a frame */

typedef struct tl_timer tl_timer;

struct tl_timer_times {
    uint64_t frame; /* the number given to tl_timer_begin */
    int count;
    struct {
        int part;
        double ms;
    } marks[TL_TIMER_MARKS_MAX]; /* in order; a part may have several */
};

/* `waits`: with the CPU's clock, for software GL (tl_gpu_is_software). */
tl_timer *tl_timer_create(bool waits);
/* Frees and nulls; accepts null. */
void tl_timer_destroy(tl_timer **timer);

/* Begins a frame. Where the times of several frames before have not been taken, the oldest are dropped. */
void tl_timer_begin(tl_timer *timer, uint64_t frame);
/* The work begun since the last mark, or since the frame began, is of this part. */
void tl_timer_mark(tl_timer *timer, int part);
/* Takes the times of the oldest frame that has ended; the frame ends with the last mark before the next
 * begins. Returns false while GL has not done it. Waits for nothing. */
bool tl_timer_take(tl_timer *timer, struct tl_timer_times *out);

#endif
