/* The renderer: surfaces, environment, lamps and settings to a linear HDR image with coverage in alpha.
 *
 * It draws surfaces and knows nothing of cloth. A frame is a const table of jobs (render/frame/jobs.c);
 * render/plan decides which of them run, and a job whose inputs have not changed is not run again.
 *
 * Unless a function below states otherwise:
 *   Errors: none.
 *   Lifetime: a renderer owns every GL object that it makes and borrows its tl_gpu, which must outlive it.
 *   Arguments are read during the call only. A function that reads "the last frame" needs the surfaces,
 *   materials and environment that were given to the last tl_renderer_draw, unchanged and not yet freed.
 *   Threads: the thread on which the renderer's tl_gpu is current. No function is safe to call while another
 * one runs on the same renderer. */
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

/* Makes a renderer that has no image yet.
 *
 * Errors: NULL, with `error` set, when GL or the ray tracer refuses an object or a shader does not compile.
 * Lifetime: release it with tl_renderer_destroy, before the tl_gpu. */
tl_renderer *tl_renderer_create(tl_gpu *gpu, tl_error *error);

/* Releases a renderer and sets the pointer to NULL; NULL is accepted. */
void tl_renderer_destroy(tl_renderer **renderer);

/* Asks for the memory that drawing takes with these settings, besides that of the scene
 * (config/base/memory.h). Before the first draw: afterwards it is in use. Errors: false, with `error` set. */
bool tl_renderer_request(const struct tl_render_settings *settings, tl_error *error);

/* Draws a frame into the renderer's own HDR target and makes it the last frame.
 *
 * Errors: false, with `error` set. A camera without an upright direction, and sizes beyond what GL can hold
 * or beyond the renderer's memory bounds, are refused before anything is drawn: the last frame stays. When a
 * job fails, there is no last frame any more and the next draw starts from nothing. Lifetime: the arrays and
 * the environment of `frame` are borrowed until the next draw by the functions that read the last frame. */
bool tl_renderer_draw(tl_renderer *renderer, const tl_frame *frame, const struct tl_render_settings *settings,
                      tl_error *error);

/* Discards all that follows from surfaces and camera, so that the next draw recomputes it as a new renderer
 * would; what follows from the environment alone is kept. Checks use it to compare reused with recomputed
 * results.
 *
 * Errors: false, with `error` set, when the ray tracer cannot be made again; only tl_renderer_destroy may
 * follow. */
bool tl_renderer_forget_scene(tl_renderer *renderer, tl_error *error);

/* Ends all averaging: the next draw treats every surface as moved and traces its visibility from nothing.
 * Results that do not depend on earlier frames are kept. */
void tl_renderer_forget(tl_renderer *renderer);

/* Returns the standard error of the last image drawn by TL_METHOD_REFERENCE, in the units of rel_rmse
 * (render/metrics/compare.h); 0 before the first one. */
double tl_renderer_standard_error(const tl_renderer *renderer);

/* Returns true when drawing the last frame again would change nothing: no jittered round is left to be
 * averaged, no shadow map and no capture waits for its turn. */
bool tl_renderer_is_at_rest(const tl_renderer *renderer);

/* Reads the HDR image back: F32 RGBA, linear, premultiplied by the coverage in alpha, black where nothing is.
 *
 * Errors: false, with `error` set and `out` unchanged, when no frame has been drawn and when GL lacks memory.
 * Lifetime: the caller releases `out` with tl_image_release. */
bool tl_renderer_read(tl_renderer *renderer, tl_image *out, tl_error *error);

/* Copies the last capture of the scene by TL_METHOD_MAPS: a cube in world axes (render/envmap/capture.h), its
 * six faces one below the other, F32 RGB.
 *
 * Errors: false, with `error` set and `out` unchanged, when nothing has been captured.
 * Lifetime: the caller releases `out` with tl_image_release. */
bool tl_renderer_read_capture(const tl_renderer *renderer, tl_image *out, tl_error *error);

/* Describes the surface under pixel (x, y) of the last frame, counted from its upper left corner. It searches
 * the samples, or traces one ray where the samples were not kept, and is cheap enough for every movement of a
 * mouse. Returns false where there is no surface, outside of the image, and before the first frame.
 *
 * Lifetime: names in `out` are borrowed from the last frame. */
bool tl_renderer_inspect(const tl_renderer *renderer, int x, int y, struct tl_inspection *out);

/* Makes the legend of the last frame's view; empty for TL_VIEW_LIGHT. */
void tl_renderer_legend(const tl_renderer *renderer, struct tl_legend *out);

/* Makes the layers (AOVs) of the last frame. Each pixel has the values of the one sample nearest to its
 * centre, because a mean of the normals or positions of different surfaces belongs to none of them.
 *
 * Errors: false, with `error` set and `out` empty, when the frame was drawn without tl_frame.aovs and when
 * GL lacks memory.
 * Lifetime: the caller releases `out` with tl_aovs_release. */
bool tl_renderer_read_aovs(const tl_renderer *renderer, struct tl_aovs *out, tl_error *error);

/* Makes the garment's layer of the last frame alone: F32, one channel, of the image's size, 1 where the
 * garment is the nearest surface, else 0.
 *
 * Errors: false, with `error` set and `out` empty, when the frame was drawn without tl_frame.aovs and when
 * GL lacks memory.
 * Lifetime: the caller releases `out` with tl_image_release. */
bool tl_renderer_read_garment(const tl_renderer *renderer, tl_image *out, tl_error *error);

/* Show the last frame's image: background, exposure, tone mapping (Khronos PBR Neutral), sRGB. The first
 * function makes an image (U8 RGB). The second draws columns [first, end) of framebuffer 0 of the current
 * context, a window of `width` x `height` pixels.
 *
 * Errors: false, with `error` set, when no frame has been drawn, and when the environment is larger than GL
 * can hold; in the second case the last frame is lost. Lifetime: the caller releases `out` with
 * tl_image_release. */
bool tl_renderer_show_image(tl_renderer *renderer, tl_image *out, tl_error *error);
bool tl_renderer_show_columns(tl_renderer *renderer, int width, int height, int first, int end,
                              tl_error *error);

/* Returns whether the graphics card would draw the frame. */
bool tl_renderer_is_on_card(const tl_renderer *renderer, const tl_frame *frame,
                            const struct tl_render_settings *settings);
/* Describes who draws the frame, the graphics card or the CPU, and why, in up to `size` bytes. */
void tl_renderer_describe_device(const tl_renderer *renderer, const tl_frame *frame,
                                 const struct tl_render_settings *settings, char *out, size_t size);
/* Makes the plan that tl_renderer_draw would follow for this frame, with its reasons and predicted times.
 * Draws nothing and changes nothing.
 *
 * Lifetime: the names in `out` are constants. */
void tl_renderer_plan(const tl_renderer *renderer, const tl_frame *frame,
                      const struct tl_render_settings *settings, tl_plan *out);

/* Returns the plan of the last draw with the times that its jobs took; empty before the first one.
 *
 * Lifetime: valid until the renderer is destroyed; the next draw overwrites it. */
const tl_plan *tl_renderer_last_plan(const tl_renderer *renderer);

/* Predict the cost of a frame to come at other settings, on the assumption that it moves as the last ones
 * did. The first function returns the jobs that would run, by bit of the table. The second returns how long
 * those jobs would take, in milliseconds; it is cheap enough to be asked for thousands of settings. A job
 * whose cost is not known yet counts as 0. Draw nothing and change nothing. */
tl_bits tl_renderer_predict_jobs(const tl_renderer *renderer, const tl_frame *frame,
                                 const struct tl_render_settings *settings);
double tl_renderer_predict_ms(const tl_renderer *renderer, const struct tl_render_settings *settings,
                              tl_bits jobs);

/* Returns the factor by which other programs slow the machine down: 1 when they do not. */
double tl_renderer_load(const tl_renderer *renderer);

/* Returns true when surfaces, camera, environment or lamps changed before the last frame, or would change
 * with this one. Options and jittered rounds do not count as motion. True before the first frame. */
bool tl_renderer_is_moving(const tl_renderer *renderer, const tl_frame *frame);

/* Changing the number of regions is cheap once the lights of the new number have been made, and these are
 * kept for the last few numbers. The first function returns whether those of `settings` are there, or nothing
 * has to be made. The second makes them, which takes as long as a few frames. */
bool tl_renderer_has_regions(const tl_renderer *renderer, const struct tl_render_settings *settings);
void tl_renderer_prepare_regions(tl_renderer *renderer, const struct tl_render_settings *settings);

/* Returns the exponents of the lobes that the last frame needed, as bits of render/env/lobes.h; 0 before the
 * first one. A worker thread that prepares an environment (render/frame/prepared.h) asks for the same ones.
 */
uint32_t tl_renderer_exponents(const tl_renderer *renderer);

/* Copies what this renderer has made of its environment, for another renderer or for a worker thread to
 * complete. Returns NULL when it has made nothing.
 *
 * Lifetime: the caller releases the copy with tl_prepared_destroy or passes it on. */
tl_prepared *tl_renderer_copy_prepared(const tl_renderer *renderer);

/* Takes over what was prepared elsewhere. Light of the present environment is used at once. Anything else is
 * kept for the next draw that makes a cube: it is used if that environment has this revision and the settings
 * are those that it was made for, and is discarded otherwise.
 *
 * Lifetime: the renderer becomes the owner of `*prepared`, which must not be NULL, and sets it to NULL. */
void tl_renderer_take_prepared(tl_renderer *renderer, tl_prepared **prepared, uint64_t environment_revision);

/* Returns the bytes that the renderer holds, by use (render/frame/bytes.h). */
struct tl_render_memory tl_renderer_memory(const tl_renderer *renderer);

/* Lists the same bytes by resource and returns the number of rows; resources that hold nothing have none.
 *
 * Lifetime: the names are constants. */
size_t tl_renderer_resources(const tl_renderer *renderer, struct tl_resource_memory out[TL_RESOURCES_MAX]);

/* Writes, for each job of the table, the bytes of the resources that it makes. Several jobs may make one. */
void tl_renderer_job_bytes(const tl_renderer *renderer, size_t out[TL_JOBS_MAX]);

#endif
