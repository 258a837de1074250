#include "render/renderer.h"

#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/frame/facts.h"
#include "render/frame/jobs.h"
#include "render/frame/memory.h"
#include "render/gpu/shaders.h"
#include "render/inspect/inspect.h"
#include "render/renderer_internal.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of a sample: in the largest texture, and in all: G-buffer, its depth, light. */
#define SAMPLE_LAYER_BYTES 16
#define SAMPLE_BYTES       (16 + 3 * 8 + 4 + 4 + 16)
/* ... and on the CPU: surfaces, light and the image, of each pixel. Measured: 230 bytes a pixel and sample
 * together, from 400 x 400 to 1200 x 1200 pixels in preset draft. */
#define CPU_SAMPLE_BYTES 176

/* Bounds on what a setting may ask the GPU for; software GL would take it from the machine's memory. */
#define BYTES_MAX         ((uint64_t)4 << 30) /* all together */
#define TEXTURE_BYTES_MAX ((uint64_t)1 << 30) /* one texture */

static uint64_t sample_count(const struct tl_image_params *image)
{
    int width, height;
    tl_image_samples(image, &width, &height);
    return (uint64_t)width * (uint64_t)height;
}

static bool check_image_size(const tl_renderer *renderer, const struct tl_image_params *image,
                             tl_error *error)
{
    int width, height;
    tl_image_samples(image, &width, &height);
    int side = width > height ? width : height;
    if (side > tl_gpu_texture_side_max(renderer->resources.gpu) ||
        sample_count(image) * SAMPLE_LAYER_BYTES > TEXTURE_BYTES_MAX)
        return tl_fail(error, TL_USAGE,
                       "image: %d x %d pixels with %d samples a side are more than GL can hold: make "
                       "image.width, image.height or image.supersample smaller",
                       image->width, image->height, image->supersample);
    return true;
}

static uint64_t map_texel_bytes(const struct tl_light_params *light)
{
    if (light->method == TL_METHOD_UNSHADOWED || light->method == TL_METHOD_MAPS ||
        light->visibility == TL_VISIBILITY_RAYS)
        return 0;
    bool halves = light->visibility == TL_VISIBILITY_DEPTH || light->moments == TL_MOMENTS_HALF;
    return halves ? TL_SHADOW_TEXEL_BYTES / 2 : TL_SHADOW_TEXEL_BYTES;
}

static bool check_light_size(const struct tl_render_settings *settings, uint64_t *bytes, tl_error *error)
{
    const struct tl_light_params *light = &settings->light;
    /* Six faces and their mips: a third more than 6, so 8. */
    bool chains = light->visibility != TL_VISIBILITY_RAYS && light->method != TL_METHOD_MAPS &&
                  tl_light_source(light) == TL_LIGHT_CHAIN;
    uint64_t pem =
        chains ? (uint64_t)light->pem_size * (uint64_t)light->pem_size * 8 * TL_PEM_TEXEL_BYTES : 0;
    uint64_t map = (uint64_t)light->map_size * (uint64_t)light->map_size * map_texel_bytes(light);
    uint64_t regions = (uint64_t)light->regions, passes = (uint64_t)light->pems_per_pass;
    uint64_t in_one_pass = chains && passes < regions ? passes : regions;
    if (in_one_pass * pem > TEXTURE_BYTES_MAX || in_one_pass * map > TEXTURE_BYTES_MAX)
        return tl_fail(error, TL_USAGE,
                       "light: %d PEMs of %d texels or maps of %d in one pass are more than %d MB: lower "
                       "light.pems_per_pass or light.map_size",
                       (int)in_one_pass, light->pem_size, light->map_size, (int)(TEXTURE_BYTES_MAX >> 20));
    *bytes = regions * (pem + map) + sample_count(&settings->image) * SAMPLE_BYTES;
    if (*bytes > BYTES_MAX)
        return tl_fail(error, TL_USAGE,
                       "light: %d regions, PEMs of %d texels, maps of %d and this image need %d MB, more "
                       "than %d: lower light.regions, light.pem_size, light.map_size or image.supersample",
                       light->regions, light->pem_size, light->map_size, (int)(*bytes >> 20),
                       (int)(BYTES_MAX >> 20));
    return true;
}

/* The settings as the jobs use them, on this GL. */
static struct tl_render_settings resolve(const tl_renderer *renderer,
                                         const struct tl_render_settings *settings)
{
    struct tl_render_settings used = tl_render_settings_resolve(settings);
    const tl_gpu *gpu = renderer->resources.gpu;
    const bool is_wanted = used.light.device == TL_DEVICE_CARD ||
                           (used.light.device == TL_DEVICE_AUTO && !tl_gpu_is_software(gpu));
    const bool can = !renderer->card_fails && !tl_card_gl_refusal(gpu);
    used.light.device = is_wanted && can ? TL_DEVICE_CARD : TL_DEVICE_CPU;
    return used;
}

bool tl_renderer_request(const struct tl_render_settings *settings, tl_error *error)
{
    uint64_t bytes = 0;
    char what[64];
    snprintf(what, sizeof what, "image: %d x %d pixels", settings->image.width, settings->image.height);
    return check_light_size(settings, &bytes, error) &&
           tl_memory_request(what, bytes + sample_count(&settings->image) * CPU_SAMPLE_BYTES, error);
}

tl_renderer *tl_renderer_create(tl_gpu *gpu, tl_error *error)
{
    tl_renderer *renderer = TL_NEW(tl_renderer);
    struct tl_resources *resources = &renderer->resources;
    resources->gpu = gpu;
    resources->surfaces = tl_surfaces_create(gpu);
    tl_surfaces_use_detail(resources->surfaces, &resources->detail);
    resources->detail.params = *(const struct tl_detail_params *)tl_detail_options.defaults;
    tl_ground_make(&(struct tl_casters){.radius = TL_CASTERS_RADIUS_MIN}, TL_GROUND_GREY, &resources->ground);
    resources->points = tl_points_create();
    resources->card = tl_card_create(gpu);
    resources->trace = tl_trace_create(error);
    resources->maps = tl_shadow_maps_create(gpu, error);
    renderer->shaders_stamp = tl_shaders_stamp(tl_embedded_shaders);
    if (!tl_gpu_is_software(gpu))
        renderer->timer = tl_timer_create(false);
    if (!resources->trace || !resources->maps || !tl_lighting_create(&resources->lighting, gpu, error) ||
        !tl_present_create(&resources->present, gpu, error) ||
        !tl_jobs_check(tl_frame_jobs, tl_frame_job_count, error) || !tl_gpu_check(gpu, error))
        tl_renderer_destroy(&renderer);
    return renderer;
}

void tl_renderer_destroy(tl_renderer **renderer)
{
    if (!*renderer)
        return;
    tl_timer_destroy(&(*renderer)->timer);
    tl_resources_release(&(*renderer)->resources);
    free(*renderer);
    *renderer = NULL;
}

static struct tl_plan_input plan_input(const tl_renderer *renderer, tl_bits facts, tl_bits changed,
                                       tl_bits wanted)
{
    /* Shadow maps that wait for their turn are out of date, so they do not count as valid. */
    tl_bits waiting =
        tl_shadow_maps_wait(renderer->resources.maps) ? TL_BIT(TL_MADE_DEPTHS) | TL_BIT(TL_MADE_MAPS) : 0;
    /* After light in motion nothing may have moved, and yet samples have no points. */
    if (!(facts & TL_BIT(TL_SCENE_RATIOS)) && !tl_points_are_for_samples(renderer->resources.points))
        waiting |= TL_BIT(TL_MADE_POINTS);
    return (struct tl_plan_input){.changed = changed,
                                  .valid = renderer->resources.valid & ~waiting,
                                  .scene = facts,
                                  .wanted = wanted,
                                  .scene_fact_names = tl_scene_fact_names,
                                  .resource_names = tl_resource_names};
}

/* The resources that callers read after a draw. */
static tl_bits read_of(const tl_frame *frame)
{
    return TL_BIT(TL_MADE_IMAGE) | (frame->aovs ? TL_BIT(TL_MADE_SAMPLES) : 0);
}

static tl_bits changed_inputs(const tl_renderer *renderer, const uint64_t hashes[TL_INPUT_COUNT])
{
    tl_bits changed = 0;
    for (int i = 0; i < TL_INPUT_COUNT; i++)
        if (hashes[i] != renderer->hashes[i])
            changed |= TL_BIT(i);
    return changed;
}

/* Invalidates every resource, so that the next frame starts from nothing: rounds must never be averaged into
 * the image of another frame. */
static void forget(tl_renderer *renderer)
{
    renderer->resources.valid = 0;
    memset(renderer->hashes, 0, sizeof renderer->hashes);
}

/* Treats all surfaces as moved. Resources that follow from the environment alone are kept, because they do
 * not depend on earlier frames. */
void tl_renderer_forget(tl_renderer *renderer)
{
    renderer->hashes[TL_INPUT_MOTION] = 0;
    renderer->rest = (struct tl_rest){0};
    tl_points_destroy(&renderer->resources.points); /* visibility at points refines earlier values */
    renderer->resources.points = tl_points_create();
    tl_shadow_maps_forget(renderer->resources.maps); /* some are older than the frame */
    tl_bounce_release(&renderer->resources.bounce);
    tl_ratios_release(&renderer->resources.ratios); /* half of them are of the frame before */
    tl_card_forget(renderer->resources.card);
}

bool tl_renderer_forget_scene(tl_renderer *renderer, tl_error *error)
{
    renderer->resources.valid &= TL_BIT(TL_MADE_CUBE) | TL_BIT(TL_MADE_REGIONS) | TL_BIT(TL_MADE_LOBE) |
                                 TL_BIT(TL_MADE_PEMS) | TL_BIT(TL_MADE_LOBES) | TL_BIT(TL_MADE_SLICES) |
                                 TL_BIT(TL_MADE_LIGHTS) | TL_BIT(TL_MADE_ENVMAP_LOBES);
    renderer->hashes[TL_INPUT_MOTION] = 0; /* ends averaging */
    renderer->rest = (struct tl_rest){0};
    tl_surfaces_destroy(&renderer->resources.surfaces);
    renderer->resources.surfaces = tl_surfaces_create(renderer->resources.gpu);
    tl_surfaces_use_detail(renderer->resources.surfaces, &renderer->resources.detail);
    tl_points_destroy(&renderer->resources.points);
    renderer->resources.points = tl_points_create();
    tl_bounce_release(&renderer->resources.bounce);
    tl_ratios_release(&renderer->resources.ratios);
    tl_card_forget(renderer->resources.card);
    tl_trace_destroy(&renderer->resources.trace);
    renderer->resources.trace = tl_trace_create(error);
    return renderer->resources.trace != NULL;
}

static double predict_job(const tl_renderer *renderer, int job, const struct tl_work *work)
{
    double slowness = renderer->slowness > 0 ? renderer->slowness : 1;
    return tl_cost_expect(&renderer->costs[job], work, tl_machine_load_factor(&renderer->load), slowness);
}

static void make_plan(const tl_renderer *renderer, const struct tl_plan_input *input,
                      const struct tl_work_counts *counts, const struct tl_render_settings *settings,
                      tl_plan *plan)
{
    double predicted_ms[TL_JOBS_MAX];
    const struct tl_work_sizes sizes = tl_work_estimate_sizes(&renderer->resources, counts, settings);
    struct tl_work work[TL_JOB_COUNT];
    tl_work_estimate(&sizes, work);
    for (int i = 0; i < TL_JOB_COUNT; i++)
        predicted_ms[i] = predict_job(renderer, i, &work[i]);
    tl_plan_make(tl_frame_jobs, tl_frame_job_count, input, predicted_ms, plan);
}

/* Each job's cost model learns from the work that the job turned out to have. The machine's load slows all
 * jobs down alike and is learned separately, from the jobs whose cost is known. */
static void learn_costs(tl_renderer *renderer, tl_plan *plan, double new_regions)
{
    struct tl_work_sizes sizes =
        tl_work_estimate_sizes(&renderer->resources, &renderer->counts, &renderer->settings);
    sizes.new_regions = new_regions; /* counted before the jobs made them */
    double predicted_ms = 0, took_ms = 0, load = tl_machine_load_factor(&renderer->load);
    struct tl_work all[TL_JOB_COUNT], work[TL_JOB_COUNT] = {{{0}}}; /* the second: of the jobs that ran */
    tl_work_estimate(&sizes, all);
    for (int i = 0; i < plan->count; i++) {
        if (plan->rows[i].action != TL_JOB_RUN)
            continue;
        struct tl_cost_job *cost = &renderer->costs[i];
        work[i] = all[i];
        plan->rows[i].work_ms = tl_work_sum(&work[i]);
        if (cost->runs >= TL_COST_KNOWN) {
            predicted_ms += tl_cost_predict(cost, &work[i], load);
            took_ms += plan->rows[i].took_ms;
        }
        tl_cost_learn(cost, &work[i], load, plan->rows[i].took_ms);
    }
    renderer->slowness = tl_cost_slowness(renderer->costs, work, plan->count);
    tl_machine_load_follow(&renderer->load, predicted_ms, took_ms);
}

/* Runs a job and everything that it asks of GL, by the CPU's clock: GL's own is wrong on software drivers. */
static bool run_and_wait(tl_renderer *renderer, int job, struct tl_plan_row *row, tl_error *error)
{
    row->began_s = tl_clock_s();
    const bool has_run = tl_frame_jobs[job].run(&renderer->resources, row->level, error);
    glFinish();
    row->took_ms = 1000 * (tl_clock_s() - row->began_s);
    return has_run && tl_gpu_check(renderer->resources.gpu, error);
}

/* Runs the jobs one after the other. */
static bool run_jobs(tl_renderer *renderer, tl_plan *plan, tl_error *error)
{
    for (int i = 0; i < plan->count; i++)
        if (plan->rows[i].action == TL_JOB_RUN && !run_and_wait(renderer, i, &plan->rows[i], error))
            return false;
    return true;
}

/* Runs the jobs without waiting for the graphics card in between, which stamps the times when they end: the
 * card is at work while the CPU prepares the next one. */
static bool queue_jobs(tl_renderer *renderer, tl_plan *plan, tl_error *error)
{
    struct tl_timer_times times;
    double began_s = tl_clock_s();
    tl_timer_begin(renderer->timer, 0);
    for (int i = 0; i < plan->count; i++) {
        if (plan->rows[i].action != TL_JOB_RUN)
            continue;
        if (!tl_frame_jobs[i].run(&renderer->resources, plan->rows[i].level, error))
            return false;
        tl_timer_mark(renderer->timer, i);
    }
    glFinish();
    while (tl_timer_take(renderer->timer, &times))
        for (int i = 0; i < times.count; i++) {
            struct tl_plan_row *row = &plan->rows[times.marks[i].part];
            row->took_ms = times.marks[i].ms;
            row->began_s = began_s;
            began_s += 1e-3 * row->took_ms;
        }
    return tl_gpu_check(renderer->resources.gpu, error);
}

static bool run_plan(tl_renderer *renderer, const struct tl_plan_input *input, tl_plan *plan, tl_error *error)
{
    make_plan(renderer, input, &renderer->counts, &renderer->settings, plan);
    double new_regions =
        tl_work_estimate_sizes(&renderer->resources, &renderer->counts, &renderer->settings).new_regions;
    tl_gpu_reset_state(renderer->resources.gpu);
    const bool queues = renderer->timer && input->scene & TL_BIT(TL_SCENE_CARD);
    if (!(queues ? queue_jobs(renderer, plan, error) : run_jobs(renderer, plan, error))) {
        forget(renderer);
        return false;
    }
    for (int i = 0; i < plan->count; i++)
        if (plan->rows[i].action == TL_JOB_RUN)
            tl_debug("%s: %.2f ms, predicted %.2f ms", plan->rows[i].name, plan->rows[i].took_ms,
                     plan->rows[i].predicted_ms);
    learn_costs(renderer, plan, new_regions);
    renderer->resources.valid = tl_plan_valid_after(tl_frame_jobs, tl_frame_job_count, input, plan);
    return true;
}

/* Reloads shader files that were edited on disk. An error in one is logged, and its old program stays in use.
 */
static void reload_shaders(tl_renderer *renderer)
{
    uint64_t stamp = tl_shaders_stamp(tl_embedded_shaders);
    if (stamp == renderer->shaders_stamp)
        return;
    renderer->shaders_stamp = stamp;
    tl_local_reload(&renderer->resources.local);
    tl_error error = {0};
    if (!tl_shadow_maps_reload(renderer->resources.maps, &error) ||
        !tl_gbuffer_reload(&renderer->resources.gbuffer, &error) ||
        !tl_ids_reload(&renderer->resources.ids, &error) ||
        !tl_ids_reload(&renderer->resources.pixel_ids, &error) ||
        !tl_gbuffer_reload(&renderer->resources.transparency.behind, &error) ||
        !tl_lighting_reload(&renderer->resources.lighting, &error) ||
        !tl_envmap_reload(&renderer->resources.envmap, &error) ||
        !tl_light_map_reload(&renderer->resources.light_map, &error) ||
        !tl_capture_reload(&renderer->resources.capture, &error) ||
        !tl_card_reload(renderer->resources.card, &error) ||
        !tl_present_reload(&renderer->resources.present, &error))
        tl_warn("%s", error.message);
    forget(renderer);
}

static bool check_camera(const struct tl_camera *camera, tl_error *error)
{
    vec3s view = glms_vec3_sub(camera->target, camera->eye);
    float upright = glms_vec3_norm(glms_vec3_cross(view, camera->up));
    if (!(upright > 1e-6f * glms_vec3_norm(view) * glms_vec3_norm(camera->up)))
        return tl_fail(error, TL_USAGE,
                       "camera: eye, target and up direction lie on one line: there is no upright to see by");
    if (!(camera->near_m > 0 && camera->far_m > camera->near_m && isfinite(camera->far_m)))
        return tl_fail(error, TL_USAGE,
                       "camera: near plane at %g m and far plane at %g m: 0 < near < far is needed",
                       (double)camera->near_m, (double)camera->far_m);
    return true;
}

static bool check_envmap_size(const tl_frame *frame, const struct tl_render_settings *settings,
                              tl_error *error)
{
    if (settings->light.method != TL_METHOD_MAPS)
        return true;
    uint32_t exponents = tl_map_exponents_of(frame->surfaces, frame->surface_count, &settings->detail);
    uint64_t bytes = tl_envmap_bytes_needed(&settings->maps, exponents);
    if (bytes > TEXTURE_BYTES_MAX)
        return tl_fail(error, TL_USAGE,
                       "maps: %d environment maps of %d texels need %d MB, more than %d: lower maps.size",
                       __builtin_popcount(exponents), settings->maps.size, (int)(bytes >> 20),
                       (int)(TEXTURE_BYTES_MAX >> 20));
    uint64_t side = (uint64_t)settings->maps.light_map;
    bytes = TL_LIGHT_MAP_TEXEL_BYTES * side * side * (frame->surface_count + 1);
    if (bytes > TEXTURE_BYTES_MAX)
        return tl_fail(
            error, TL_USAGE,
            "maps: light maps of %d texels for %zu surfaces need %d MB, more than %d: lower maps.light_map",
            settings->maps.light_map, frame->surface_count + 1, (int)(bytes >> 20),
            (int)(TEXTURE_BYTES_MAX >> 20));
    return true;
}

/* Releases resources that the scene does not need any more; jobs make them again on demand. A view other than
 * light releases nothing that light needs, and ratios at vertices release nothing that samples need, so that
 * switching back, as at the end of a motion, is quick. The height of bumps follows the options even where
 * there are no detail maps. */
static void release_unused(struct tl_resources *resources, const struct tl_detail_params *detail)
{
    tl_bits facts = resources->facts;
    if (!(facts & (TL_BIT(TL_SCENE_DETAIL) | TL_BIT(TL_SCENE_RATIOS))))
        tl_detail_maps_release(&resources->detail);
    resources->detail.params = *detail;
    if (facts & (TL_BIT(TL_SCENE_INSPECT) | TL_BIT(TL_SCENE_RATIOS)))
        return;
    if (!(facts & TL_BIT(TL_SCENE_LAMPS))) {
        tl_local_release(&resources->local);
        resources->valid &=
            ~(TL_BIT(TL_MADE_LAMP_MAPS) | TL_BIT(TL_MADE_LAMP_RAYS) | TL_BIT(TL_MADE_LAMPLIGHT));
    }
    if (!(facts & TL_BIT(TL_SCENE_TRANSPARENCY))) {
        tl_transparency_release(&resources->transparency);
        resources->valid &= ~TL_BIT(TL_MADE_TRANSPARENCY);
    }
}

static struct tl_motion_state motion_state_of(const tl_renderer *renderer)
{
    const tl_bits moves_shadows = TL_BIT(TL_INPUT_MOTION) | TL_BIT(TL_INPUT_YAW);
    return (struct tl_motion_state){.still = renderer->frame.still,
                                    .moves_shadows = renderer->moving & moves_shadows,
                                    .moves_lamps = renderer->moving & TL_BIT(TL_INPUT_LAMPS)};
}

bool tl_renderer_draw(tl_renderer *renderer, const tl_frame *frame, const struct tl_render_settings *settings,
                      tl_error *error)
{
    struct tl_render_settings used = resolve(renderer, settings);
    struct tl_resources *resources = &renderer->resources;
    uint64_t bytes = 0;
    if (!check_camera(&frame->camera, error) || !check_image_size(renderer, &used.image, error) ||
        !check_light_size(&used, &bytes, error) || !check_envmap_size(frame, &used, error))
        return false;
    reload_shaders(renderer);
    const tl_bits facts = tl_frame_facts(frame, &used);
    uint64_t hashes[TL_INPUT_COUNT];
    tl_frame_hash_inputs(frame, &used, facts, renderer->hashes, &renderer->rest, hashes);
    tl_bits changed = changed_inputs(renderer, hashes);
    if (resources->valid) /* the first frame has no earlier one to differ from */
        renderer->moving = changed;
    renderer->frame = *frame;
    renderer->counts = tl_work_count(frame, &used, facts, resources->light_cache.exponents);
    renderer->settings = used;
    memcpy(renderer->hashes, hashes, sizeof hashes);
    tl_inputs_set(resources, frame, &used, facts, &renderer->rest, hashes);
    resources->motion_state = motion_state_of(renderer);
    release_unused(resources, &used.detail);
    const struct tl_plan_input input = plan_input(renderer, facts, changed, read_of(frame));
    bool fine = run_plan(renderer, &input, &renderer->plan, error);
    if (!fine && facts & TL_BIT(TL_SCENE_CARD) && settings->light.device == TL_DEVICE_AUTO) {
        tl_warn("%s: the CPU draws from now on", error->message);
        *error = (tl_error){0};
        renderer->card_fails = true;
        return tl_renderer_draw(renderer, frame, settings, error);
    }
    const bool waits = resources->facts & TL_BIT(TL_SCENE_BOUNCE) && !resources->bounce.is_done;
    const bool traces = resources->facts & TL_BIT(TL_SCENE_SHADOWS);
    renderer->rest.is_done = (resources->points_are_done || !traces) && !waits;
    return fine;
}

static bool require_image(const tl_renderer *renderer, const char *purpose, tl_error *error)
{
    if (!(renderer->resources.valid & TL_BIT(TL_MADE_IMAGE)))
        return tl_fail(error, TL_USAGE, "renderer: there is no image to %s: draw a frame first", purpose);
    return true;
}

/* Hands an image that was read from GL over to the caller, if all of it was read. */
static bool hand_over(const tl_renderer *renderer, tl_image *image, tl_image *out, tl_error *error)
{
    bool is_whole = tl_gpu_check(renderer->resources.gpu, error);
    if (is_whole)
        *out = *image;
    else
        tl_image_release(image);
    return is_whole;
}

bool tl_renderer_read(tl_renderer *renderer, tl_image *out, tl_error *error)
{
    if (!require_image(renderer, "read", error))
        return false;
    tl_gpu_reset_state(renderer->resources.gpu);
    tl_image image;
    tl_linear_image_read(&renderer->resources.present.image, &image);
    return hand_over(renderer, &image, out, error);
}

bool tl_renderer_read_capture(const tl_renderer *renderer, tl_image *out, tl_error *error)
{
    const tl_cube *cube = &renderer->resources.capture.cube;
    if (!(renderer->resources.valid & TL_BIT(TL_MADE_CAPTURE)))
        return tl_fail(error, TL_USAGE,
                       "renderer: no scene was captured: draw a frame with light.method maps and "
                       "maps.capture_every above 0");
    *out = tl_image_create(cube->size, 6 * cube->size, 3, TL_IMAGE_F32);
    memcpy(out->texels, cube->texels, 18 * sizeof(float) * (size_t)cube->size * (size_t)cube->size);
    return true;
}

/* Makes the picture of the last image, unless this part of it is there. */
static bool show(tl_renderer *renderer, const struct tl_picture_part *part, tl_error *error)
{
    struct tl_resources *resources = &renderer->resources;
    if (!tl_picture_has(&resources->present.picture, part))
        resources->valid &= ~TL_BIT(TL_MADE_SHOWN);
    resources->show_part = *part;
    tl_plan plan;
    /* No input counts as changed: the image is shown as it was drawn, even if the scene has changed since. */
    const struct tl_plan_input input = {.valid = resources->valid,
                                        .scene = resources->facts,
                                        .wanted = TL_BIT(TL_MADE_SHOWN),
                                        .scene_fact_names = tl_scene_fact_names,
                                        .resource_names = tl_resource_names};
    return run_plan(renderer, &input, &plan, error);
}

bool tl_renderer_show_image(tl_renderer *renderer, tl_image *out, tl_error *error)
{
    const struct tl_linear_image *image = &renderer->resources.present.image;
    const struct tl_picture_part whole = {
        .width = image->width, .height = image->height, .end_column = image->width};
    if (!require_image(renderer, "show", error) || !show(renderer, &whole, error))
        return false;
    tl_image picture;
    tl_picture_read(&renderer->resources.present.picture, &picture);
    return hand_over(renderer, &picture, out, error);
}

bool tl_renderer_show_columns(tl_renderer *renderer, int width, int height, int first, int end,
                              tl_error *error)
{
    const struct tl_picture_part part = {
        .width = width, .height = height, .first_column = first, .end_column = end};
    if (!require_image(renderer, "show", error) || !show(renderer, &part, error))
        return false;
    tl_picture_copy(&renderer->resources.present.picture, renderer->resources.gpu, 0, first, end);
    return true;
}

void tl_renderer_plan(const tl_renderer *renderer, const tl_frame *frame,
                      const struct tl_render_settings *settings, tl_plan *out)
{
    struct tl_render_settings used = resolve(renderer, settings);
    const tl_bits facts = tl_frame_facts(frame, &used);
    uint64_t hashes[TL_INPUT_COUNT];
    struct tl_rest rest = renderer->rest;
    tl_frame_hash_inputs(frame, &used, facts, renderer->hashes, &rest, hashes);
    const struct tl_plan_input input =
        plan_input(renderer, facts, changed_inputs(renderer, hashes), read_of(frame));
    const struct tl_work_counts counts =
        tl_work_count(frame, &used, facts, renderer->resources.light_cache.exponents);
    make_plan(renderer, &input, &counts, &used, out);
}

bool tl_renderer_is_on_card(const tl_renderer *renderer, const tl_frame *frame,
                            const struct tl_render_settings *settings)
{
    const struct tl_render_settings used = resolve(renderer, settings);
    return used.light.device == TL_DEVICE_CARD && tl_frame_facts(frame, &used) & TL_BIT(TL_SCENE_CARD);
}

void tl_renderer_describe_device(const tl_renderer *renderer, const tl_frame *frame,
                                 const struct tl_render_settings *settings, char *out, size_t size)
{
    const struct tl_render_settings used = resolve(renderer, settings);
    const tl_gpu *gpu = renderer->resources.gpu;
    const bool rests = used.light.ratio_at != TL_RATIO_AT_VERTICES;
    const char *refusal = rests ? tl_frame_rest_refusal(frame, &used) : tl_frame_card_refusal(frame, &used);
    if (tl_renderer_is_on_card(renderer, frame, settings))
        snprintf(out, size, "the graphics card, by %s", tl_gpu_name(gpu));
    else if (settings->light.device == TL_DEVICE_CPU)
        snprintf(out, size, "the CPU, as light.device states");
    else if (settings->light.device == TL_DEVICE_AUTO && tl_gpu_is_software(gpu))
        snprintf(out, size, "the CPU: OpenGL runs on it as well");
    else if (renderer->card_fails)
        snprintf(out, size, "the CPU: a frame of the graphics card failed");
    else if (tl_card_gl_refusal(gpu))
        snprintf(out, size, "the CPU: %s", tl_card_gl_refusal(gpu));
    else
        snprintf(out, size, "the CPU: the graphics card does not draw %s%s", refusal ? refusal : "this frame",
                 rests ? " at rest" : "");
}

/* Inputs that can change without the user: their change counts as motion. Options change only by hand. */
#define MOVING_INPUTS                                                                                        \
    (TL_BIT(TL_INPUT_ENVIRONMENT) | TL_BIT(TL_INPUT_YAW) | TL_BIT(TL_INPUT_MOTION) |                         \
     TL_BIT(TL_INPUT_CAMERA) | TL_BIT(TL_INPUT_LAYOUT) | TL_BIT(TL_INPUT_CAPTURE) | TL_BIT(TL_INPUT_LAMPS))
#define ROUND_INPUTS (TL_BIT(TL_INPUT_ROUND) | TL_BIT(TL_INPUT_SCENE_ROUND))

tl_bits tl_renderer_predict_jobs(const tl_renderer *renderer, const tl_frame *frame,
                                 const struct tl_render_settings *settings)
{
    struct tl_render_settings used = resolve(renderer, settings);
    const tl_bits facts = tl_frame_facts(frame, &used);
    uint64_t hashes[TL_INPUT_COUNT];
    struct tl_rest rest = renderer->rest;
    tl_frame_hash_inputs(frame, &used, facts, renderer->hashes, &rest, hashes);
    tl_bits moving = renderer->moving ? renderer->moving : TL_BIT(TL_INPUT_MOTION);
    tl_bits changed = changed_inputs(renderer, hashes) | (moving & MOVING_INPUTS) | ROUND_INPUTS;
    const struct tl_plan_input input = plan_input(renderer, facts, changed, read_of(frame));
    tl_plan plan;
    tl_plan_make(tl_frame_jobs, tl_frame_job_count, &input, NULL, &plan);
    tl_bits jobs = 0;
    for (int i = 0; i < plan.count; i++)
        if (plan.rows[i].action == TL_JOB_RUN)
            jobs |= (tl_bits)1 << i;
    return jobs;
}

double tl_renderer_predict_ms(const tl_renderer *renderer, const struct tl_render_settings *settings,
                              tl_bits jobs)
{
    double sum_ms = 0;
    const struct tl_work_sizes sizes =
        tl_work_estimate_sizes(&renderer->resources, &renderer->counts, settings);
    struct tl_work work[TL_JOB_COUNT];
    tl_work_estimate(&sizes, work);
    for (int i = 0; i < TL_JOB_COUNT; i++) {
        if (!(jobs & (tl_bits)1 << i))
            continue;
        double ms = predict_job(renderer, i, &work[i]);
        sum_ms += isfinite(ms) ? ms : 0;
    }
    return sum_ms;
}

double tl_renderer_load(const tl_renderer *renderer)
{
    return tl_machine_load_factor(&renderer->load);
}

bool tl_renderer_is_moving(const tl_renderer *renderer, const tl_frame *frame)
{
    uint64_t hashes[TL_INPUT_COUNT];
    struct tl_rest rest = renderer->rest;
    /* Facts decide how rounds are counted, and rounds are no motion: those of the last frame do. */
    tl_frame_hash_inputs(frame, &renderer->settings, renderer->resources.facts, renderer->hashes, &rest,
                         hashes);
    tl_bits moving = renderer->moving | changed_inputs(renderer, hashes);
    return !renderer->resources.valid || moving & (MOVING_INPUTS | TL_BIT(TL_INPUT_SHAPES));
}

bool tl_renderer_has_regions(const tl_renderer *renderer, const struct tl_render_settings *settings)
{
    const struct tl_render_settings used = resolve(renderer, settings);
    const tl_bits needed = TL_BIT(TL_MADE_CUBE) | TL_BIT(TL_MADE_LOBES) | TL_BIT(TL_MADE_LIGHTS);
    return (renderer->resources.valid & needed) != needed ||
           tl_light_cache_has(&renderer->resources.light_cache, &used.light);
}

void tl_renderer_prepare_regions(tl_renderer *renderer, const struct tl_render_settings *settings)
{
    const struct tl_render_settings used = resolve(renderer, settings);
    if (!tl_renderer_has_regions(renderer, &used))
        tl_light_cache_prepare(&renderer->resources.light_cache, &renderer->resources.cube, &used.light);
}

double tl_renderer_standard_error(const tl_renderer *renderer)
{
    return renderer->resources.standard_error;
}

bool tl_renderer_is_at_rest(const tl_renderer *renderer)
{
    const struct tl_light_params *light = &renderer->settings.light;
    const struct tl_rest *rest = &renderer->rest;
    bool is_done = light->visibility == TL_VISIBILITY_RAYS ? rest->is_done : rest->image >= light->rounds - 1;
    bool averages = tl_light_averages(light) && tl_inspect_averages(renderer->settings.image.view);
    bool waits = light->visibility != TL_VISIBILITY_RAYS && tl_shadow_maps_wait(renderer->resources.maps);
    /* Shifted samples have rounds of their own, of which the image needs one each. */
    bool is_refined = rest->shift_set > 0 ? rest->shifts_left == 0 : is_done || !averages;
    return renderer->resources.valid & TL_BIT(TL_MADE_IMAGE) && rest->is_captured && !waits && is_refined;
}

const tl_plan *tl_renderer_last_plan(const tl_renderer *renderer)
{
    return &renderer->plan;
}
