/* One surface under one lamp, shaded again and again with nothing else: what `toile bench shading` measures.
 * Threads: the one that the GL context is current on. */
#ifndef TOILE_RENDER_LOCAL_SHADING_BENCH_H
#define TOILE_RENDER_LOCAL_SHADING_BENCH_H

#include "render/light/light.h"
#include "render/local/local.h"

struct tl_shading_bench {
    tl_gpu *gpu;
    tl_surfaces *surfaces;
    struct tl_gbuffer gbuffer;
    struct tl_lighting lighting;
    struct tl_local local;
    struct tl_view view;
    struct tl_casters casters;
    struct tl_lamp lamp;
};

bool tl_shading_bench_create(struct tl_shading_bench *out, tl_gpu *gpu, tl_error *error);
void tl_shading_bench_release(struct tl_shading_bench *trial);

/* Takes what is seen; the surface need not stay. Programs that were made are kept. */
bool tl_shading_bench_set_scene(struct tl_shading_bench *trial, const tl_surface *surface,
                                const struct tl_camera *camera, const struct tl_lamp *lamp, int width,
                                int height, tl_error *error);

/* Makes the target black, and whatever was drawn before is done. */
void tl_shading_bench_clear(struct tl_shading_bench *trial);
/* Shades, without shadows, and waits until that is done. */
bool tl_shading_bench_draw(struct tl_shading_bench *trial, const struct tl_shading_params *params,
                           tl_error *error);
/* What was drawn: F32 RGBA, rows upwards. */
tl_image tl_shading_bench_read(const struct tl_shading_bench *trial);

#endif
