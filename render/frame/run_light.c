/* Jobs that light what the camera sees. */
#include "render/frame/run.h"

#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"
#include "render/light/compose.h"
#include "render/local/lamp_samples.h"

#include <string.h>

bool tl_run_light(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    const struct tl_light_request request = {.gbuffer = &renderer->gbuffer,
                                             .pems = &renderer->pems,
                                             .slices = &renderer->slice_maps,
                                             .regions = &renderer->regions,
                                             .suns = &renderer->suns,
                                             .maps = renderer->maps,
                                             .casters = renderer->casters,
                                             .ground = tl_frame_ground(renderer),
                                             .environment_yaw = renderer->frame.environment_yaw,
                                             .eye = renderer->view.eye,
                                             .round = renderer->rest.image,
                                             .params = &renderer->settings.light};
    return tl_lighting_draw(&renderer->lighting, renderer->gpu, &request, error);
}

/* A still image takes all its rounds before it is lit. */
static void update_points(tl_renderer *renderer, struct tl_points_request *request)
{
    const struct tl_light_params *light = &renderer->settings.light;
    struct tl_progress progress = tl_progress_begin("averaging");
    tl_points_update(renderer->points, request);
    bool goes_on = renderer->frame.still && tl_light_averages(light);
    for (int round = 1; goes_on && !tl_points_are_done(renderer->points) && !tl_interrupted(); round++) {
        request->moved = false;
        tl_points_update(renderer->points, request);
        tl_progress_update(&progress, round, light->rounds);
    }
    tl_progress_end(&progress);
    renderer->rest.is_done = tl_points_are_done(renderer->points);
}

bool tl_run_points(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    if (!tl_frame_follow_motion(renderer, error))
        return false;
    const struct tl_ray_params params = tl_light_ray_params(&renderer->settings.light);
    struct tl_points_request request = {.trace = renderer->trace,
                                        .ranges = &renderer->ranges,
                                        .samples = &renderer->samples,
                                        .regions = &renderer->regions,
                                        .suns = &renderer->suns,
                                        .regions_revision = renderer->regions_revision,
                                        .shapes_revision = renderer->signatures[TL_INPUT_SHAPES],
                                        .ground = tl_frame_ground(renderer),
                                        .environment_yaw = renderer->frame.environment_yaw,
                                        .params = &params,
                                        .moved = renderer->rest.scene == 0,
                                        .whole_rounds = renderer->frame.still};
    update_points(renderer, &request);
    return true;
}

/* Which back-end shadows each lamp, kept for the jobs that follow. */
static size_t list_lamps(tl_renderer *renderer, struct tl_lamp lamps[TL_LAMPS_MAX])
{
    size_t count = tl_lamps_lit(&renderer->frame, lamps);
    for (size_t i = 0; i < count; i++)
        renderer->local.shadows.kinds[i] =
            tl_lamp_shadow_of(&lamps[i], &renderer->settings.light, &renderer->casters);
    return count;
}

/* Of samples that no pass of the GPU knows. */
static bool add_lamps(tl_renderer *renderer, const struct tl_compose_request *composed, tl_error *error)
{
    struct tl_lamp lamps[TL_LAMPS_MAX];
    const struct tl_lamp_samples_request request = {.lamp_count = list_lamps(renderer, lamps),
                                                    .lamps = lamps,
                                                    .shadowed = renderer->settings.light.method !=
                                                                TL_METHOD_UNSHADOWED,
                                                    .trace = renderer->trace,
                                                    .samples = &renderer->samples,
                                                    .shares = composed->shares,
                                                    .mirrors = composed->mirrors,
                                                    .ranges = &renderer->ranges,
                                                    .ground = tl_frame_ground(renderer),
                                                    .eye = renderer->view.eye};
    if (request.lamp_count == 0 || renderer->samples.count == renderer->samples.primary_count)
        return true;
    if (request.shadowed && !tl_frame_follow_motion(renderer, error))
        return false;
    tl_lamp_samples_add(&request, renderer->light);
    return true;
}

void tl_frame_clear_light(tl_renderer *renderer)
{
    const struct tl_samples *samples = &renderer->samples;
    size_t bytes = (size_t)samples->width * (size_t)samples->height * 4 * sizeof(float);
    if (bytes != renderer->light_bytes) {
        free(renderer->light);
        renderer->light = tl_alloc(bytes, 1);
        renderer->light_bytes = bytes;
    }
    memset(renderer->light, 0, bytes);
}

bool tl_run_compose(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    tl_frame_clear_light(renderer);
    struct tl_compose_request request = {.samples = &renderer->samples,
                                         .lights = renderer->lights,
                                         .suns = &renderer->suns,
                                         .lobes = &renderer->lobes,
                                         .environment = renderer->frame.environment,
                                         .environment_yaw = renderer->frame.environment_yaw,
                                         .params = &renderer->settings.light,
                                         .eye = renderer->view.eye};
    if (tl_frame_has(&renderer->frame, tl_material_is_layered))
        request.ranges = &renderer->ranges;
    if (tl_frame_facts(&renderer->frame, &renderer->settings) & TL_BIT(TL_SCENE_TRANSPARENCY))
        request.shares = renderer->transparency.shares;
    if (renderer->settings.light.method != TL_METHOD_UNSHADOWED) {
        request.values = tl_points_values(renderer->points, &request.stride);
        request.taps = tl_points_taps(renderer->points);
        if (tl_frame_facts(&renderer->frame, &renderer->settings) & TL_BIT(TL_SCENE_MIRRORS))
            request.mirrors = renderer->mirrors.items;
        for (int i = 0; i < renderer->suns.count; i++)
            request.sun_visibility[i] = tl_points_sun(renderer->points, i);
    }
    tl_compose(&request, renderer->light);
    if (!add_lamps(renderer, &request, error))
        return false;
    tl_lighting_set(&renderer->lighting, renderer->gpu, &renderer->gbuffer, renderer->light);
    return true;
}

bool tl_run_lamp_maps(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    struct tl_lamp lamps[TL_LAMPS_MAX];
    const struct tl_lamp_maps_request request = {.lamp_count = list_lamps(renderer, lamps),
                                                 .lamps = lamps,
                                                 .caster_surfaces = renderer->frame.surfaces,
                                                 .caster_count = renderer->frame.surface_count,
                                                 .casters = renderer->casters,
                                                 .surfaces = renderer->surfaces,
                                                 .map_size = renderer->settings.light.map_size};
    return tl_lamp_maps_draw(&renderer->local.shadows, renderer->gpu, &request, error);
}

bool tl_run_lamp_rays(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    if (!tl_frame_follow_motion(renderer, error))
        return false;
    struct tl_lamp lamps[TL_LAMPS_MAX];
    struct tl_lamp_shadows *shadows = &renderer->local.shadows;
    const struct tl_samples *samples = &renderer->samples;
    size_t count = list_lamps(renderer, lamps);
    uint8_t *visible = TL_NEW_ARRAY(uint8_t, (size_t)samples->width * (size_t)samples->height);
    for (size_t i = 0; i < count; i++) {
        if (shadows->kinds[i] != TL_LAMP_SHADOW_RAYS)
            continue;
        tl_lamp_rays(&lamps[i], renderer->trace, samples, &renderer->ranges, tl_frame_ground(renderer),
                     visible);
        tl_lamp_shadows_set(shadows, renderer->gpu, samples->width, samples->height, i, count, visible);
    }
    free(visible);
    return true;
}

bool tl_run_lamps(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    struct tl_lamp lamps[TL_LAMPS_MAX];
    /* Passes average their rounds in the target. */
    bool passes = tl_frame_facts(&renderer->frame, &renderer->settings) & TL_BIT(TL_SCENE_PASSES);
    const struct tl_local_request request = {.gbuffer = &renderer->gbuffer,
                                             .light = &renderer->lighting.target,
                                             .view = &renderer->view,
                                             .surfaces = renderer->surfaces,
                                             .surface_count = renderer->surface_count,
                                             .ground = tl_frame_ground(renderer),
                                             .casters = renderer->casters,
                                             .lamp_count = list_lamps(renderer, lamps),
                                             .lamps = lamps,
                                             .params = &renderer->settings.shading,
                                             .detail = &renderer->settings.detail,
                                             .depth_bias_m = renderer->settings.light.depth_bias_m,
                                             .weight = passes ? 1 / (float)(renderer->rest.image + 1) : 1};
    return tl_local_draw(&renderer->local, renderer->gpu, &request, error);
}
