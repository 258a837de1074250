/* The renderer: surfaces + environment + settings -> a linear HDR image with coverage in alpha.
 *
 * It sees surfaces only, never cloth. The frame is a const table of jobs (render/frame/jobs.c); what runs is
 * decided by render/plan. Owns every GL object it makes. Threads: the one its tl_gpu is current on. */
#ifndef TOILE_RENDER_RENDERER_H
#define TOILE_RENDER_RENDERER_H

#include "render/frame/bytes.h"
#include "render/frame/prepared.h"
#include "render/frame/settings.h"
#include "render/gpu/gpu.h"
#include "render/inspect/aovs.h"
#include "render/inspect/inspect.h"
#include "render/plan/plan.h"
#include "render/scene/frame.h"

typedef struct tl_renderer tl_renderer;

tl_renderer *tl_renderer_create(tl_gpu *gpu, tl_error *error);
void tl_renderer_destroy(tl_renderer **renderer);

/* Draws the frame into the renderer's own HDR target. Work that nothing changed is not repeated. */
bool tl_renderer_draw(tl_renderer *renderer, const tl_frame *frame, const struct tl_render_settings *settings,
                      tl_error *error);

/* The next draw makes anew all that follows from surfaces and camera, as a new renderer would; what was made
 * of the environment alone stays. For checks: what is reused must equal what is made anew. */
bool tl_renderer_forget_scene(tl_renderer *renderer, tl_error *error);

/* Of the image by TL_METHOD_REFERENCE that was drawn last, as rel_rmse of render/metrics/compare.h; 0 before.
 */
double tl_renderer_standard_error(const tl_renderer *renderer);

/* True once drawing the same frame again would change nothing: no jittered round is left to be averaged. */
bool tl_renderer_is_at_rest(const tl_renderer *renderer);

/* What is drawn next owes nothing to what was drawn before, as in a new renderer. */
void tl_renderer_forget(tl_renderer *renderer);

/* The HDR image: F32 RGBA, linear, alpha = coverage, premultiplied, black where nothing is. */
bool tl_renderer_read(tl_renderer *renderer, tl_image *out, tl_error *error);

/* The scene as it was last captured by TL_METHOD_MAPS, a cube in world axes (render/envmap/capture.h); not
 * when nothing was. */
bool tl_renderer_read_capture(const tl_renderer *renderer, tl_image *out, tl_error *error);

/* What lies under pixel (x, y) of the image drawn last, counted from its upper left corner. False where
 * nothing is, or no image. Cheap: a search among the samples, or a ray where they were not kept. */
bool tl_renderer_inspect(const tl_renderer *renderer, int x, int y, struct tl_inspection *out);

/* The legend of the image drawn last; empty for TL_VIEW_LIGHT. */
void tl_renderer_legend(const tl_renderer *renderer, struct tl_legend *out);

/* Of the image drawn last, whose frame must have asked for layers and still be there. Each pixel has the
 * values of the one sample nearest to its middle: normals and places of different surfaces have no mean.
 * `out` is to be released. */
bool tl_renderer_read_aovs(const tl_renderer *renderer, struct tl_aovs *out, tl_error *error);

/* For show: background, exposure, tone mapping (Khronos PBR Neutral), sRGB. To an image (U8 RGB), or to
 * columns [first, end) of the current window's buffer 0, whose size is given in pixels. The drawn frame's
 * environment must still be there. */
bool tl_renderer_show_image(tl_renderer *renderer, tl_image *out, tl_error *error);
bool tl_renderer_show_columns(tl_renderer *renderer, int width, int height, int first, int end,
                              tl_error *error);

/* What draw would do with this frame, and why; and what it has taken so far. Pure but for reading the
 * renderer's state. */
void tl_renderer_plan(const tl_renderer *renderer, const tl_frame *frame,
                      const struct tl_render_settings *settings, tl_plan *out);
const tl_plan *tl_renderer_last_plan(const tl_renderer *renderer);

/* What a frame to come would take if it moves as the last ones did, for those who choose its settings: first
 * which jobs (by bit) would run, then how long they would take; the last is cheap enough to be asked for
 * thousands of settings. Both pure but for reading the renderer's state. */
tl_bits tl_renderer_predict_jobs(const tl_renderer *renderer, const tl_frame *frame,
                                 const struct tl_render_settings *settings);
double tl_renderer_predict_ms(const tl_renderer *renderer, const struct tl_render_settings *settings,
                              tl_bits jobs); /* ms */
/* How much slower the machine is than it was: other programs'; 1: not. */
double tl_renderer_load(const tl_renderer *renderer);
/* False while nothing but jittered rounds and options made the last frame different from the one before, and
 * would make this one different from it. */
bool tl_renderer_is_moving(const tl_renderer *renderer, const tl_frame *frame);
/* Going to the regions of these settings is cheap once they have been prepared, which takes as long as some
 * frames do; so are those of the last frames. True where there is nothing to prepare. */
bool tl_renderer_has_regions(const tl_renderer *renderer, const struct tl_render_settings *settings);
void tl_renderer_prepare_regions(tl_renderer *renderer, const struct tl_render_settings *settings);

/* What an environment was made into on a worker thread (frame/prepared.h): the exponents that the last frame
 * needed (0 before), a copy of what this renderer has made, and taking what was made elsewhere. */
uint32_t tl_renderer_exponents(const tl_renderer *renderer);
/* What this renderer has made of its environment, for another one or to be added to; NULL when it has made
 * nothing. */
tl_prepared *tl_renderer_copy_prepared(const tl_renderer *renderer);
/* More light of the same cube is taken at once. Else it is for the next draw, which uses it if its
 * environment has this revision and its settings are those that it was made for. Nulls it. */
void tl_renderer_take_prepared(tl_renderer *renderer, tl_prepared **prepared, uint64_t environment_revision);

/* See frame/bytes.h. */
struct tl_render_memory tl_renderer_memory(const tl_renderer *renderer);

size_t tl_renderer_resources(const tl_renderer *renderer, struct tl_resource_memory out[TL_RESOURCES_MAX]);

#endif
