/* Jobs that light what the camera sees. */
#include "config/base/hash.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/frame/facts.h"
#include "render/frame/job_io.h"
#include "render/light/compose.h"
#include "render/local/lamp_samples.h"
#include "render/present/resample.h"
#include "render/shade/outlines.h"

#include <stdlib.h>

bool tl_run_light(const struct tl_light_job *job, tl_error *error)
{
    const struct tl_light_request request = {.gbuffer = job->gbuffer,
                                             .pems = job->pems,
                                             .lobe_levels = job->lobe_levels,
                                             .exact = job->exact->lobes,
                                             .exact_revision = job->exact->revision,
                                             .slices = &job->slices->maps,
                                             .sums = *job->facts & TL_BIT(TL_SCENE_LOBE_SUMS) ? job->lobe_sums
                                                                                              : NULL,
                                             .regions = job->regions,
                                             .suns = job->suns,
                                             .maps = job->maps,
                                             .casters = *job->casters,
                                             .ground = job->ground_input->is_drawn ? job->ground : NULL,
                                             .environment_yaw = *job->yaw,
                                             .eye = job->camera->view.eye,
                                             .round = *job->round,
                                             .params = job->light_options};
    return tl_lighting_draw(job->lighting, job->gpu, &request, job->light, error);
}

bool tl_run_lobe_sums(const struct tl_lobe_sums_job *job, tl_error *error)
{
    (void)error;
    const struct tl_lobe_sums_request request = {.samples = job->samples,
                                                 .ranges = &job->shapes->ranges,
                                                 .eye = job->camera->view.eye,
                                                 .max_count = job->light_options->lobes};
    tl_lobe_sums_make(job->lobe_sums, job->gpu, &request);
    return true;
}

/* A still image takes all its rounds before it is lit. */
static void take_rounds(const struct tl_points_job *job, struct tl_points_request *request)
{
    const struct tl_rays_input *options = job->rays;
    struct tl_progress progress = tl_progress_begin("averaging");
    tl_points_update(job->points, request);
    bool goes_on = job->motion_state->still && options->averages;
    for (int round = 1; goes_on && !tl_points_are_done(job->points) && !tl_interrupted(); round++) {
        request->moved = false;
        tl_points_update(job->points, request);
        tl_progress_update(&progress, round, options->params.rounds);
    }
    tl_progress_end(&progress);
}

bool tl_run_points(const struct tl_points_job *job, tl_error *error)
{
    (void)error;
    bool at_vertices = *job->facts & TL_BIT(TL_SCENE_RATIOS);
    struct tl_points_request request = {.trace = job->trace,
                                        .ranges = &job->shapes->ranges,
                                        .samples = at_vertices ? NULL : job->samples,
                                        .seen = job->ids->seen,
                                        .seen_count = job->ids->seen_count,
                                        .regions = job->regions,
                                        .suns = job->suns,
                                        .regions_revision = *job->regions_revision,
                                        .shapes_revision = job->shapes->revision,
                                        .ground = job->ground_input->is_drawn ? job->ground : NULL,
                                        .environment_yaw = *job->yaw,
                                        .params = &job->rays->params,
                                        .moved = *job->scene_round == 0,
                                        .only_camera =
                                            at_vertices && *job->scene_round > 0 && *job->round == 0,
                                        .whole_rounds = job->motion_state->still};
    take_rounds(job, &request);
    *job->points_are_done = tl_points_are_done(job->points);
    return true;
}

/* A still image takes all its rounds. */
bool tl_run_bounce(const struct tl_bounce_job *job, tl_error *error)
{
    (void)error;
    enum { ROUNDS_MAX = 64 };
    bool at_vertices = *job->facts & TL_BIT(TL_SCENE_RATIOS);
    struct tl_bounce_request request = {.trace = job->trace,
                                        .ranges = &job->shapes->ranges,
                                        .shapes_revision = job->shapes->revision,
                                        .ground = job->ground_input->is_drawn ? job->ground : NULL,
                                        .cube = job->cube,
                                        .cube_revision = job->environment->revision,
                                        .lobes = job->exact->lobes,
                                        .suns = job->suns,
                                        .lamps = job->lamps->items,
                                        .lamp_count = job->lamps->count,
                                        .environment_yaw = *job->yaw,
                                        .samples = at_vertices ? NULL : job->samples,
                                        .seen = job->ids->seen,
                                        .seen_count = job->ids->seen_count,
                                        .all = job->light_options->bounce == TL_BOUNCE_ALL,
                                        .moved = *job->scene_round == 0 || job->motion_state->moves_lamps,
                                        .at_once = job->motion_state->still,
                                        .shares = job->light_options->bounce_shares};
    tl_bounce_update(job->bounce, &request);
    request.moved = false;
    for (int i = 0; i < ROUNDS_MAX && request.at_once && !job->bounce->is_done && !tl_interrupted(); i++)
        tl_bounce_update(job->bounce, &request);
    return true;
}

static uint64_t light_revision(const struct tl_ratios_job *job)
{
    uint64_t hash = tl_hash(TL_HASH_START, job->regions_revision, sizeof *job->regions_revision);
    hash = tl_hash(hash, &job->shapes->revision, sizeof job->shapes->revision);
    hash = tl_hash(hash, &job->environment->revision, sizeof job->environment->revision);
    hash = tl_hash(hash, job->light_options, sizeof *job->light_options);
    return tl_hash(hash, job->yaw, sizeof *job->yaw);
}

bool tl_run_ratios(const struct tl_ratios_job *job, tl_error *error)
{
    (void)error;
    const struct tl_ratios_request request = {.ids = job->ids,
                                              .ranges = &job->shapes->ranges,
                                              .materials = job->shade_materials,
                                              .points = job->points,
                                              .lights = *job->lights,
                                              .region_count = (int)job->regions->count,
                                              .lobes = job->exact->lobes,
                                              .bounce =
                                                  *job->facts & TL_BIT(TL_SCENE_BOUNCE) ? job->bounce : NULL,
                                              .environment_yaw = *job->yaw,
                                              .eye = job->camera->view.eye,
                                              .params = job->light_options,
                                              .light_revision = light_revision(job),
                                              .shapes_revision = job->shapes->revision};
    tl_ratios_make(job->ratios, &request);
    return true;
}

bool tl_run_sun_pixels(const struct tl_sun_pixels_job *job, tl_error *error)
{
    (void)error;
    tl_pixel_triangles_make(job->pixel_triangles, job->ids, &job->shift->view, &job->shapes->ranges,
                            job->shade_materials);
    struct tl_pixel_lights lights;
    tl_pixel_lights_make(job->suns, *job->yaw, job->lamps->items, job->lamps->count, &lights);
    const struct tl_sun_pixels_request request = {.ids = job->ids,
                                                  .triangles = job->pixel_triangles,
                                                  .ranges = &job->shapes->ranges,
                                                  .lights = &lights,
                                                  .trace = job->trace,
                                                  .openness = job->shade_materials->openness,
                                                  .ground = job->ground_input->is_drawn ? job->ground : NULL};
    tl_sun_pixels_update(job->sun_pixels, &request);
    return true;
}

/* Turns light at samples into the picture. */
static void enlarge(const struct tl_shade_job *job, const float *shaded)
{
    const struct tl_size_input *size = job->size;
    const struct tl_resample resample = {.from = shaded,
                                         .from_width = size->columns,
                                         .from_height = size->rows,
                                         .to = tl_present_begin_cpu_image(job->present, size->options.width,
                                                                          size->options.height,
                                                                          job->shift->before),
                                         .to_width = size->options.width,
                                         .to_height = size->options.height};
    const struct tl_outlines_request outlines = {.samples = job->ids,
                                                 .pixels = job->pixel_ids,
                                                 .light = shaded,
                                                 .ranges = &job->shapes->ranges,
                                                 .materials = job->shade_materials,
                                                 .ground = job->ground_input->is_drawn ? job->ground : NULL,
                                                 .view = &job->shift->view};
    tl_resample(&resample);
    if (tl_size_has_outlines(size))
        tl_outlines_draw(&outlines, resample.to);
    tl_present_end_cpu_image(job->present);
}

bool tl_run_shade(const struct tl_shade_job *job, tl_error *error)
{
    (void)error;
    struct tl_pixel_lights lights;
    tl_pixel_lights_make(job->suns, *job->yaw, job->lamps->items, job->lamps->count, &lights);
    const struct tl_pixels_request request = {.ids = job->ids,
                                              .triangles = job->pixel_triangles,
                                              .ranges = &job->shapes->ranges,
                                              .materials = job->shade_materials,
                                              .ratios = job->ratios,
                                              .lobes = job->exact->lobes,
                                              .lights = &lights,
                                              .sun_pixels = job->sun_pixels,
                                              .cover_m = tl_points_cover_m(job->trace),
                                              .ground = job->ground_input->is_drawn ? job->ground : NULL,
                                              .view = &job->shift->view,
                                              .environment_yaw = *job->yaw};
    const struct tl_size_input *size = job->size;
    int side = size->columns / size->options.width;
    if (side * size->options.width == size->columns && side * size->options.height == size->rows) {
        tl_pixels_shade(&request, side,
                        tl_present_begin_cpu_image(job->present, size->options.width, size->options.height,
                                                   job->shift->before));
        tl_present_end_cpu_image(job->present);
        return true;
    }
    float *shaded = tl_resize(NULL, 4 * (size_t)size->columns * (size_t)size->rows, sizeof *shaded);
    tl_pixels_shade(&request, 1, shaded);
    enlarge(job, shaded);
    free(shaded);
    return true;
}

/* Adds the lamps' light, and what surfaces emit, to the samples that no pass on the GPU covers: behind open
 * cloth, through cloth, in mirrors. */
static void add_lamps(const struct tl_compose_job *job, const struct tl_compose_request *composed)
{
    const struct tl_lamp_samples_request request = {
        .lamp_count = job->lamps->count,
        .lamps = job->lamps->items,
        .shadowed = job->light_options->method != TL_METHOD_UNSHADOWED,
        .trace = job->trace,
        .samples = job->samples,
        .shares = composed->shares,
        .mirrors = composed->mirrors,
        .ranges = &job->shapes->ranges,
        .ground = job->ground_input->is_drawn ? job->ground : NULL,
        .eye = job->camera->view.eye};
    bool emits = tl_materials_have(job->shapes->surfaces, job->shapes->surface_count, tl_material_emits);
    if ((request.lamp_count > 0 || emits) && job->samples->count > job->samples->primary_count)
        tl_lamp_samples_add(&request, job->light->texels);
}

bool tl_run_compose(const struct tl_compose_job *job, tl_error *error)
{
    (void)error;
    const struct tl_shapes_input *shapes = job->shapes;
    static const struct tl_region_lights no_lights = {0};
    const bool is_shadowed = *job->facts & TL_BIT(TL_SCENE_SHADOWS);
    tl_light_buffer_clear(job->light, job->samples->width, job->samples->height);
    struct tl_compose_request request = {
        .samples = job->samples,
        .lights = is_shadowed ? *job->lights : &no_lights,
        .suns = job->suns,
        .lobes = job->exact->lobes,
        .environment = job->environment->map,
        .environment_yaw = *job->yaw,
        .params = job->light_options,
        .ranges = &shapes->ranges,
        .any_layered = tl_materials_have(shapes->surfaces, shapes->surface_count, tl_material_is_layered),
        .eye = job->camera->view.eye};
    if (*job->facts & TL_BIT(TL_SCENE_BOUNCE))
        request.bounce = job->bounce;
    if (*job->facts & TL_BIT(TL_SCENE_TRANSPARENCY))
        request.shares = job->transparency->shares;
    if (*job->facts & TL_BIT(TL_SCENE_MIRRORS))
        request.mirrors = job->mirrors->items;
    if (is_shadowed) {
        request.values = tl_points_values(job->points, &request.stride);
        request.taps = tl_points_taps(job->points);
        for (int i = 0; i < job->suns->count; i++)
            request.sun_visibility[i] = tl_points_sun(job->points, i);
    }
    tl_compose(&request, job->light->texels);
    add_lamps(job, &request);
    if (*job->facts & TL_BIT(TL_SCENE_LAMPS)) /* the rest of their light is added on the GPU */
        tl_light_buffer_send(job->light, job->gpu, &job->gbuffer->target);
    else
        tl_light_buffer_finish(job->light, job->samples);
    return true;
}

/* The back-end that shadows each lamp. */
static void choose_shadows(const struct tl_lamps_input *lamps, const struct tl_light_params *light,
                           const struct tl_casters *casters, struct tl_lamp_shadows *shadows)
{
    for (size_t i = 0; i < lamps->count; i++)
        shadows->kinds[i] = tl_lamp_shadow_of(&lamps->items[i], light, casters);
}

bool tl_run_lamp_maps(const struct tl_lamp_maps_job *job, tl_error *error)
{
    choose_shadows(job->lamps, job->light_options, job->casters, &job->local->shadows);
    const struct tl_lamp_maps_request request = {.lamp_count = job->lamps->count,
                                                 .lamps = job->lamps->items,
                                                 .caster_surfaces = job->motion->surfaces,
                                                 .caster_count = job->motion->surface_count,
                                                 .casters = *job->casters,
                                                 .surfaces = job->surfaces,
                                                 .map_size = job->shadows->options.map_size};
    return tl_lamp_maps_draw(&job->local->shadows, job->gpu, &request, error);
}

bool tl_run_lamp_rays(const struct tl_lamp_rays_job *job, tl_error *error)
{
    (void)error;
    struct tl_lamp_shadows *shadows = &job->local->shadows;
    const struct tl_samples *samples = job->samples;
    size_t count = job->lamps->count;
    choose_shadows(job->lamps, job->light_options, job->casters, shadows);
    uint8_t *visible = TL_NEW_ARRAY(uint8_t, (size_t)samples->width * (size_t)samples->height);
    for (size_t i = 0; i < count; i++) {
        if (shadows->kinds[i] != TL_LAMP_SHADOW_RAYS)
            continue;
        tl_lamp_rays(&job->lamps->items[i], job->trace, samples, &job->shapes->ranges,
                     job->ground_input->is_drawn ? job->ground : NULL, visible);
        tl_lamp_shadows_set(shadows, job->gpu, samples->width, samples->height, i, count, visible);
    }
    free(visible);
    return true;
}

bool tl_run_lamps(const struct tl_lamps_job *job, tl_error *error)
{
    choose_shadows(job->lamps, job->light_options, job->casters, &job->local->shadows);
    /* Passes average their rounds in the target. */
    bool passes = *job->facts & TL_BIT(TL_SCENE_PASSES);
    const struct tl_local_request request = {.gbuffer = job->gbuffer,
                                             .light = &job->light->target,
                                             .view = &job->shift->view,
                                             .surfaces = job->surfaces,
                                             .drawn = job->shapes->drawn,
                                             .surface_count = job->shapes->drawn_count,
                                             .ground = job->ground_input->is_drawn ? job->ground : NULL,
                                             .casters = *job->casters,
                                             .lamp_count = job->lamps->count,
                                             .lamps = job->lamps->items,
                                             .params = &job->lamps->shading,
                                             .detail = job->detail_steps,
                                             .depth_bias_m = tl_casters_scale(job->casters) *
                                                             job->light_options->depth_bias_m,
                                             .weight = passes ? 1 / (float)(*job->round + 1) : 1};
    return tl_local_draw(job->local, job->gpu, &request, error);
}
