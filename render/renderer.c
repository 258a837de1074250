#include "render/renderer.h"

#include "config/log.h"
#include "config/memory.h"
#include "render/frame/frame.h"
#include "render/shaders.h"

#include <epoxy/gl.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bounds on what a setting may ask the GPU for; software GL would take it from the machine's memory. */
#define BYTES_MAX         ((uint64_t)4 << 30) /* all together */
#define TEXTURE_BYTES_MAX ((uint64_t)1 << 30) /* one texture */

#define FNV_OFFSET 14695981039346656037u
#define FNV_PRIME  1099511628211u

static uint64_t mix(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * FNV_PRIME;
    return hash;
}
#define MIX(hash, field) mix(hash, &(field), sizeof(field))

static uint64_t shapes_signature(const tl_frame *frame)
{
    uint64_t hash = MIX(FNV_OFFSET, frame->surface_count);
    for (size_t i = 0; i < frame->surface_count; i++) {
        const tl_surface *surface = &frame->surfaces[i];
        hash = MIX(MIX(MIX(hash, surface->topology_revision), surface->vertex_count), surface->index_count);
    }
    return hash;
}

static uint64_t motion_signature(const tl_frame *frame)
{
    uint64_t hash = FNV_OFFSET;
    for (size_t i = 0; i < frame->surface_count; i++)
        hash = MIX(hash, frame->surfaces[i].motion_revision);
    return hash;
}

static uint64_t camera_signature(const struct tl_camera *camera)
{
    uint64_t hash = MIX(MIX(MIX(FNV_OFFSET, camera->eye), camera->target), camera->up);
    return MIX(MIX(MIX(hash, camera->fov_y), camera->near_m), camera->far_m);
}

static uint64_t light_signature(const struct tl_light_params *light)
{
    uint64_t hash = MIX(MIX(FNV_OFFSET, light->method), light->lobe);
    return MIX(MIX(MIX(hash, light->depth_bias_m), light->min_variance), light->bleed_reduction);
}

/* One number for each input of the frame: an input has changed when its number has. */
static void sign_inputs(const tl_frame *frame, const struct tl_render_settings *settings,
                        uint64_t signatures[TL_INPUT_COUNT])
{
    const struct tl_light_params *light = &settings->light;
    const struct tl_image_params *image = &settings->image;
    const uint64_t start = FNV_OFFSET;
    signatures[TL_INPUT_ENVIRONMENT] = MIX(start, frame->environment_revision);
    signatures[TL_INPUT_YAW] = MIX(start, frame->environment_yaw);
    signatures[TL_INPUT_SHAPES] = shapes_signature(frame);
    signatures[TL_INPUT_MOTION] = motion_signature(frame);
    signatures[TL_INPUT_CAMERA] = camera_signature(&frame->camera);
    signatures[TL_INPUT_SIZE] = MIX(MIX(MIX(start, image->width), image->height), image->supersample);
    signatures[TL_INPUT_GROUND] = MIX(start, image->ground);
    signatures[TL_INPUT_PEM_SIZE] = MIX(start, light->pem_size);
    signatures[TL_INPUT_FILTER] = MIX(start, light->filter);
    signatures[TL_INPUT_REGIONS] = MIX(start, light->regions);
    signatures[TL_INPUT_PASSES] = MIX(start, light->pems_per_pass);
    signatures[TL_INPUT_MAPS] = MIX(MIX(start, light->map_size), light->blur_m);
    signatures[TL_INPUT_LIGHT] = light_signature(light);
    signatures[TL_INPUT_SHOW] = MIX(MIX(start, image->exposure_ev), image->background);
}

/* Settings as the algorithm can use them: regions in sixes, sizes in powers of two. */
static struct tl_render_settings usable(const struct tl_render_settings *settings)
{
    struct tl_render_settings used = *settings;
    used.light.regions = used.light.regions / 6 * 6;
    while (used.light.pem_size & (used.light.pem_size - 1))
        used.light.pem_size &= used.light.pem_size - 1;
    return used;
}

static uint64_t sample_count(const struct tl_image_params *image)
{
    return (uint64_t)image->width * (uint64_t)image->height *
           (uint64_t)(image->supersample * image->supersample);
}

static bool check_image_size(const tl_renderer *renderer, const struct tl_image_params *image,
                             tl_error *error)
{
    int side = image->supersample * (image->width > image->height ? image->width : image->height);
    if (side > tl_gpu_texture_side_max(renderer->gpu) ||
        sample_count(image) * TL_SAMPLE_LAYER_BYTES > TEXTURE_BYTES_MAX)
        return tl_fail(error, TL_USAGE,
                       "image: %d x %d pixels with %d samples a side are more than GL can hold: make "
                       "image.width, image.height or image.supersample smaller",
                       image->width, image->height, image->supersample);
    return true;
}

static bool check_light_size(const struct tl_render_settings *settings, tl_error *error)
{
    const struct tl_light_params *light = &settings->light;
    /* Six faces and their mips: a third more than 6, so 8. */
    uint64_t pem = (uint64_t)light->pem_size * (uint64_t)light->pem_size * 8 * TL_PEM_TEXEL_BYTES;
    uint64_t map = (uint64_t)light->map_size * (uint64_t)light->map_size * TL_SHADOW_TEXEL_BYTES;
    uint64_t regions = (uint64_t)light->regions, passes = (uint64_t)light->pems_per_pass;
    uint64_t in_one_pass = regions < passes ? regions : passes;
    if (in_one_pass * pem > TEXTURE_BYTES_MAX || in_one_pass * map > TEXTURE_BYTES_MAX)
        return tl_fail(error, TL_USAGE,
                       "light: %d PEMs of %d texels or maps of %d in one pass are more than %d MB: lower "
                       "light.pems_per_pass",
                       (int)in_one_pass, light->pem_size, light->map_size, (int)(TEXTURE_BYTES_MAX >> 20));
    uint64_t maps = light->method == TL_METHOD_UNSHADOWED ? 0 : regions * map;
    uint64_t bytes = regions * pem + maps + sample_count(&settings->image) * TL_SAMPLE_BYTES;
    if (bytes > BYTES_MAX)
        return tl_fail(error, TL_USAGE,
                       "light: %d regions, PEMs of %d texels, maps of %d and this image need %d MB, more "
                       "than %d: lower light.regions, light.pem_size, light.map_size or image.supersample",
                       light->regions, light->pem_size, light->map_size, (int)(bytes >> 20),
                       (int)(BYTES_MAX >> 20));
    return true;
}

tl_renderer *tl_renderer_create(tl_gpu *gpu, tl_error *error)
{
    tl_renderer *renderer = TL_NEW(tl_renderer);
    renderer->gpu = gpu;
    renderer->surfaces = tl_surfaces_create(gpu);
    renderer->maps = tl_shadow_maps_create(gpu, error);
    renderer->shaders_stamp = tl_shaders_stamp(tl_embedded_shaders);
    if (!renderer->maps || !tl_gbuffer_create(&renderer->gbuffer, gpu, error) ||
        !tl_lighting_create(&renderer->lighting, gpu, error) ||
        !tl_present_create(&renderer->present, gpu, error) ||
        !tl_jobs_check(tl_frame_jobs, tl_frame_job_count, error))
        tl_renderer_destroy(&renderer);
    return renderer;
}

void tl_renderer_destroy(tl_renderer **renderer)
{
    if (!*renderer)
        return;
    tl_cube_release(&(*renderer)->cube);
    tl_pems_release(&(*renderer)->pems);
    tl_surfaces_destroy(&(*renderer)->surfaces);
    tl_shadow_maps_destroy(&(*renderer)->maps);
    tl_gbuffer_release(&(*renderer)->gbuffer);
    tl_lighting_release(&(*renderer)->lighting);
    tl_present_release(&(*renderer)->present);
    free(*renderer);
    *renderer = NULL;
}

static tl_bits scene_facts(const struct tl_render_settings *settings)
{
    return settings->light.method == TL_METHOD_UNSHADOWED ? 0 : TL_BIT(TL_SCENE_SHADOWED);
}

static struct tl_plan_input plan_input(const tl_renderer *renderer, const struct tl_render_settings *settings,
                                       tl_bits changed, enum tl_resource wanted)
{
    return (struct tl_plan_input){.changed = changed,
                                  .valid = renderer->valid,
                                  .scene = scene_facts(settings),
                                  .wanted = TL_BIT(wanted),
                                  .scene_fact_names = tl_scene_fact_names,
                                  .resource_names = tl_resource_names};
}

static tl_bits changed_inputs(const tl_renderer *renderer, const uint64_t signatures[TL_INPUT_COUNT])
{
    tl_bits changed = 0;
    for (int i = 0; i < TL_INPUT_COUNT; i++)
        if (signatures[i] != renderer->signatures[i])
            changed |= TL_BIT(i);
    return changed;
}

static bool run_plan(tl_renderer *renderer, const struct tl_plan_input *input, tl_plan *plan, tl_error *error)
{
    tl_plan_make(tl_frame_jobs, tl_frame_job_count, input, &renderer->cost, plan);
    tl_gpu_reset_state(renderer->gpu);
    for (int i = 0; i < plan->count; i++) {
        if (plan->rows[i].action != TL_JOB_RUN)
            continue;
        double started_s = tl_clock_s();
        if (!tl_frame_jobs[i].run(renderer, plan->rows[i].level, error)) {
            renderer->valid = 0;
            return false;
        }
        /* The CPU's clock around a finished job: GL's own timers are wrong on software drivers. */
        glFinish();
        plan->rows[i].took_ms = 1000 * (tl_clock_s() - started_s);
        tl_cost_add(&renderer->cost, i, plan->rows[i].level, plan->rows[i].took_ms);
    }
    renderer->valid = tl_plan_valid_after(tl_frame_jobs, tl_frame_job_count, input, plan);
    return true;
}

/* Shader files edited on disk take effect at the next draw; an error in one is told, and the old one stays.
 */
static void reload_shaders(tl_renderer *renderer)
{
    uint64_t stamp = tl_shaders_stamp(tl_embedded_shaders);
    if (stamp == renderer->shaders_stamp)
        return;
    renderer->shaders_stamp = stamp;
    tl_error error = {0};
    if (!tl_shadow_maps_reload(renderer->maps, &error) ||
        !tl_program_reload(&renderer->gbuffer.program, &error) ||
        !tl_program_reload(&renderer->lighting.program, &error) ||
        !tl_program_reload(&renderer->present.resolve, &error) ||
        !tl_program_reload(&renderer->present.show, &error))
        tl_warn("%s", error.message);
    renderer->valid = 0;
}

bool tl_renderer_draw(tl_renderer *renderer, const tl_frame *frame, const struct tl_render_settings *settings,
                      tl_error *error)
{
    struct tl_render_settings used = usable(settings);
    if (!check_image_size(renderer, &used.image, error) || !check_light_size(&used, error))
        return false;
    reload_shaders(renderer);
    uint64_t signatures[TL_INPUT_COUNT];
    sign_inputs(frame, &used, signatures);
    tl_bits changed = changed_inputs(renderer, signatures);
    renderer->frame = *frame;
    renderer->settings = used;
    renderer->view = tl_view_make(&frame->camera, used.image.width, used.image.height);
    memcpy(renderer->signatures, signatures, sizeof signatures);
    const struct tl_plan_input input = plan_input(renderer, &used, changed, TL_MADE_IMAGE);
    return run_plan(renderer, &input, &renderer->plan, error);
}

/* GL's rows run upwards, an image's downwards. */
static void flip_rows(tl_image *image, size_t row_bytes)
{
    char *rows = image->texels, *spare = tl_alloc(1, row_bytes);
    for (int y = 0; y < image->height / 2; y++) {
        char *upper = rows + (size_t)y * row_bytes,
             *lower = rows + (size_t)(image->height - 1 - y) * row_bytes;
        memcpy(spare, upper, row_bytes);
        memcpy(upper, lower, row_bytes);
        memcpy(lower, spare, row_bytes);
    }
    free(spare);
}

bool tl_renderer_read(tl_renderer *renderer, tl_image *out, tl_error *error)
{
    if (!(renderer->valid & TL_BIT(TL_MADE_IMAGE)))
        return tl_fail(error, TL_USAGE, "renderer: there is no image to read: draw a frame first");
    const tl_target *target = &renderer->present.image;
    *out = tl_image_create(target->width, target->height, 4, TL_IMAGE_F32);
    size_t row_bytes = (size_t)target->width * 4 * sizeof(float);
    tl_gpu_reset_state(renderer->gpu);
    glGetTextureImage(target->colours[0].id, 0, GL_RGBA, GL_FLOAT,
                      (GLsizei)(row_bytes * (size_t)target->height), out->texels);
    flip_rows(out, row_bytes);
    return true;
}

static bool show(tl_renderer *renderer, unsigned framebuffer, int width, int height, tl_error *error)
{
    if (!(renderer->valid & TL_BIT(TL_MADE_IMAGE)))
        return tl_fail(error, TL_USAGE, "renderer: there is no image to show: draw a frame first");
    renderer->show_framebuffer = framebuffer;
    renderer->show_width = width;
    renderer->show_height = height;
    renderer->valid &=
        ~TL_BIT(TL_MADE_SHOWN); /* a window's buffer holds nothing from one frame to the next */
    tl_plan plan;
    const struct tl_plan_input input = plan_input(renderer, &renderer->settings, 0, TL_MADE_SHOWN);
    return run_plan(renderer, &input, &plan, error);
}

bool tl_renderer_show_image(tl_renderer *renderer, tl_image *out, tl_error *error)
{
    const tl_target *target = &renderer->present.shown;
    if (!show(renderer, target->id, target->width, target->height, error))
        return false;
    *out = tl_image_create(target->width, target->height, 3, TL_IMAGE_U8);
    size_t row_bytes = (size_t)target->width * 3;
    glGetTextureImage(target->colours[0].id, 0, GL_RGB, GL_UNSIGNED_BYTE,
                      (GLsizei)(row_bytes * (size_t)target->height), out->texels);
    flip_rows(out, row_bytes);
    return true;
}

bool tl_renderer_show_window(tl_renderer *renderer, int width, int height, tl_error *error)
{
    return show(renderer, 0, width, height, error);
}

void tl_renderer_plan(const tl_renderer *renderer, const tl_frame *frame,
                      const struct tl_render_settings *settings, tl_plan *out)
{
    struct tl_render_settings used = usable(settings);
    uint64_t signatures[TL_INPUT_COUNT];
    sign_inputs(frame, &used, signatures);
    const struct tl_plan_input input =
        plan_input(renderer, &used, changed_inputs(renderer, signatures), TL_MADE_IMAGE);
    tl_plan_make(tl_frame_jobs, tl_frame_job_count, &input, &renderer->cost, out);
}

const tl_plan *tl_renderer_last_plan(const tl_renderer *renderer)
{
    return &renderer->plan;
}

struct tl_render_memory tl_renderer_memory(const tl_renderer *renderer)
{
    const struct tl_present *present = &renderer->present;
    struct tl_render_memory memory = {
        .pems = tl_pems_bytes(&renderer->pems),
        .maps = tl_shadow_maps_bytes(renderer->maps),
        .targets = tl_target_bytes(&renderer->gbuffer.target) + tl_target_bytes(&renderer->lighting.target) +
                   tl_present_bytes(present),
        .surfaces = tl_surfaces_bytes(renderer->surfaces),
        .other = tl_texture_bytes(&renderer->lighting.lobe_levels) + tl_texture_bytes(&present->backdrop) +
                 tl_texture_bytes(&present->blurred),
    };
    memory.total = memory.pems + memory.maps + memory.targets + memory.surfaces + memory.other;
    return memory;
}
