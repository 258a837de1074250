/* Tests whether GL's own timers measure how long work takes. They do on hardware; software drivers end a
 * query when the work is queued, not when it is done. The renderer therefore measures with the CPU's clock
 * around finished work, which is right everywhere; this test reports whether a timer would be as good. */
#ifndef TOILE_RENDER_GPU_CLOCKS_H
#define TOILE_RENDER_GPU_CLOCKS_H

#include "render/gpu/gpu.h"

struct tl_gpu_clocks {
    double cpu_ms, timer_ms; /* of the same work */
    bool timer_is_trusted;   /* they agree about it, and about a quarter of it */
};
bool tl_gpu_compare_clocks(tl_gpu *gpu, struct tl_gpu_clocks *out, tl_error *error);

#endif
