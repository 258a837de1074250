/* One surface under one lamp, shaded repeatedly without anything else: what `toile bench shading` measures.
 * Needs the GL context of its tl_gpu. */
#ifndef TOILE_RENDER_LOCAL_SHADING_BENCH_H
#define TOILE_RENDER_LOCAL_SHADING_BENCH_H

#include "render/light/light_buffer.h"
#include "render/local/local.h"

struct tl_shading_bench {
    tl_gpu *gpu;
    tl_surfaces *surfaces;
    struct tl_gbuffer gbuffer;
    struct tl_light_buffer light;
    struct tl_local local;
    struct tl_view view;
    struct tl_casters casters;
    struct tl_lamp lamp;
};

/* Released by tl_shading_bench_release. */
void tl_shading_bench_create(struct tl_shading_bench *out, tl_gpu *gpu);
void tl_shading_bench_release(struct tl_shading_bench *bench);

/* Sets the scene and draws its G-buffer. The surface is copied to the GPU. Compiled programs are kept. */
bool tl_shading_bench_set_scene(struct tl_shading_bench *bench, const tl_surface *surface,
                                const struct tl_camera *camera, const struct tl_lamp *lamp, int width,
                                int height, tl_error *error);

/* Clears the target and waits until all previous commands have finished. */
void tl_shading_bench_clear(struct tl_shading_bench *bench);
/* Shades without shadows and waits until that has finished. */
bool tl_shading_bench_draw(struct tl_shading_bench *bench, const struct tl_shading_params *params,
                           tl_error *error);
/* Reads the target: F32 RGBA, rows upwards. The caller releases the image. */
tl_image tl_shading_bench_read(const struct tl_shading_bench *bench);

#endif
