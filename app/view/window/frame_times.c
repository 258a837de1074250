#include "app/view/window/frame_times.h"

#include <math.h>

#define FIRST_BIN_MS 0.01
#define BIN_RATIO    1.01

void tl_frame_times_add(struct tl_frame_times *times, double ms)
{
    size_t slot = (times->first + times->count) % TL_FRAME_TIMES_SHOWN;
    times->last[slot] = (float)ms;
    if (times->count < TL_FRAME_TIMES_SHOWN)
        times->count++;
    else
        times->first = (times->first + 1) % TL_FRAME_TIMES_SHOWN;
    double place = ms > FIRST_BIN_MS ? floor(log(ms / FIRST_BIN_MS) / log(BIN_RATIO)) : 0;
    times->bins[(size_t)fmin(place, TL_FRAME_TIMES_BINS - 1)]++;
    times->total++;
    times->worst_ms = fmax(times->worst_ms, ms);
}

float tl_frame_times_at(const struct tl_frame_times *times, size_t i)
{
    return times->last[(times->first + i) % TL_FRAME_TIMES_SHOWN];
}

double tl_frame_times_quantile(const struct tl_frame_times *times, double share)
{
    size_t wanted = (size_t)ceil(share * (double)times->total), seen = 0;
    if (times->total == 0)
        return 0;
    for (size_t i = 0; i < TL_FRAME_TIMES_BINS; i++) {
        seen += times->bins[i];
        if (seen >= wanted && seen > 0)
            return fmin(FIRST_BIN_MS * pow(BIN_RATIO, (double)i + 1), times->worst_ms);
    }
    return times->worst_ms;
}
