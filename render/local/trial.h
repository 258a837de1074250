/* One surface under one lamp, shaded again and again with nothing else: what `toile bench shading` measures.
 * Threads: the one that the GL context is current on. */
#ifndef TOILE_RENDER_LOCAL_TRIAL_H
#define TOILE_RENDER_LOCAL_TRIAL_H

#include "render/light/light.h"
#include "render/local/local.h"

struct tl_local_trial {
    tl_gpu *gpu;
    tl_surfaces *surfaces;
    struct tl_gbuffer gbuffer;
    struct tl_lighting lighting;
    struct tl_local local;
    struct tl_view view;
    struct tl_casters casters;
    struct tl_lamp lamp;
};

bool tl_local_trial_create(struct tl_local_trial *out, tl_gpu *gpu, tl_error *error);
void tl_local_trial_release(struct tl_local_trial *trial);

/* Takes what is seen; the surface need not stay. Programs that were made are kept. */
bool tl_local_trial_show(struct tl_local_trial *trial, const tl_surface *surface,
                         const struct tl_camera *camera, const struct tl_lamp *lamp, int width, int height,
                         tl_error *error);

/* Makes the target black, and whatever was drawn before is done. */
void tl_local_trial_clear(struct tl_local_trial *trial);
/* Shades, without shadows, and waits until that is done. */
bool tl_local_trial_draw(struct tl_local_trial *trial, const struct tl_shading_params *params,
                         tl_error *error);
/* What was drawn: F32 RGBA, rows upwards. */
tl_image tl_local_trial_read(const struct tl_local_trial *trial);

#endif
