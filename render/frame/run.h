/* The run functions of the table of jobs (jobs.c), by what they work on. Each takes the tl_renderer. */
#ifndef TOILE_RENDER_FRAME_RUN_H
#define TOILE_RENDER_FRAME_RUN_H

#include "render/frame/frame.h"

/* run_environment.c */
bool tl_run_cube(void *context, int level, tl_error *error);
bool tl_run_regions(void *context, int level, tl_error *error);
bool tl_run_lobes(void *context, int level, tl_error *error);
bool tl_run_slices(void *context, int level, tl_error *error);
bool tl_run_lobe(void *context, int level, tl_error *error);
bool tl_run_pems(void *context, int level, tl_error *error);
bool tl_run_lights(void *context, int level, tl_error *error);
bool tl_run_backdrop(void *context, int level, tl_error *error);

/* run_surfaces.c */
bool tl_run_surfaces(void *context, int level, tl_error *error);
bool tl_run_detail(void *context, int level, tl_error *error);
bool tl_run_maps(void *context, int level, tl_error *error);
bool tl_run_blur(void *context, int level, tl_error *error);
bool tl_run_gbuffer(void *context, int level, tl_error *error);
bool tl_run_samples(void *context, int level, tl_error *error);
bool tl_run_transparency(void *context, int level, tl_error *error);
bool tl_run_mirrors(void *context, int level, tl_error *error);

/* run_light.c */
bool tl_run_light(void *context, int level, tl_error *error);
bool tl_run_points(void *context, int level, tl_error *error);
bool tl_run_compose(void *context, int level, tl_error *error);
bool tl_run_lamp_maps(void *context, int level, tl_error *error);
bool tl_run_lamp_rays(void *context, int level, tl_error *error);
bool tl_run_lamps(void *context, int level, tl_error *error);

/* run_image.c */
bool tl_run_envmap_lobes(void *context, int level, tl_error *error);
bool tl_run_capture(void *context, int level, tl_error *error);
bool tl_run_envmap(void *context, int level, tl_error *error);
bool tl_run_look_up(void *context, int level, tl_error *error);
bool tl_run_reference(void *context, int level, tl_error *error);
bool tl_run_resolve(void *context, int level, tl_error *error);
bool tl_run_show(void *context, int level, tl_error *error);

const struct tl_ground *tl_frame_ground(const tl_renderer *renderer); /* NULL: none is drawn */
/* Whoever asks the rays first in a frame brings them up to date; that costs nothing when they are. */
bool tl_frame_follow_motion(tl_renderer *renderer, tl_error *error);

#endif
