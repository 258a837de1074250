#include "render/frame/frame.h"

#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"
#include "render/frame/work.h"
#include "render/inspect/job.h"
#include "render/light/compose.h"
#include "render/local/lamp_rays.h"
#include "render/local/lamp_samples.h"
#include "render/reference/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct tl_ground *ground_of(const tl_renderer *renderer)
{
    return renderer->settings.image.ground ? &renderer->ground : NULL;
}

static bool run_cube(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_cube_release(&renderer->cube);
    tl_lobes_release(&renderer->lobes);
    renderer->light_revision++;
    renderer->cube = tl_cube_from_environment_with(renderer->frame.environment,
                                                   renderer->settings.light.pem_size, &renderer->pour);
    renderer->suns = (struct tl_suns){0};
    if (renderer->settings.light.sun)
        tl_suns_take(&renderer->cube, renderer->frame.environment, &renderer->suns);
    return true;
}

static bool run_regions(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    const struct tl_light_params *light = &renderer->settings.light;
    (void)level, (void)error;
    if (light->cut == TL_CUT_SPHERE)
        tl_regions_cut_sphere(&renderer->cube, light->regions, &renderer->regions);
    else
        tl_regions_cut(&renderer->cube, light->regions, &renderer->regions);
    renderer->regions_revision++;
    return true;
}

static bool run_lobes(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_lobes_make(&renderer->lobes, &renderer->cube,
                  tl_frame_exponents(&renderer->frame, &renderer->settings.detail));
    renderer->light_revision++;
    tl_lighting_set_exact(&renderer->lighting, renderer->gpu, &renderer->lobes);
    return true;
}

/* Slices of other regions, or of another cube, are of no use. */
static bool run_slices(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_slices_release(&renderer->slices);
    tl_slices_make(&renderer->slices, &renderer->cube, &renderer->regions,
                   tl_frame_exponents(&renderer->frame, &renderer->settings.detail));
    tl_slice_maps_upload(&renderer->slice_maps, renderer->gpu, &renderer->slices);
    return true;
}

static bool run_lobe(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    struct tl_lobe_table table;
    tl_lobe_calibrate(renderer->settings.light.pem_size,
                      (enum tl_chain_filter)renderer->settings.light.filter, &table);
    tl_lighting_set_lobe(&renderer->lighting, renderer->gpu, &table);
    return true;
}

static bool run_pems(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_pems_build(&renderer->pems, renderer->gpu, &renderer->cube, &renderer->regions,
                  renderer->settings.light.filter, renderer->settings.light.pems_per_pass);
    return true;
}

static enum tl_region_weight region_weight(const struct tl_light_params *light)
{
    return light->method == TL_METHOD_LIGHTS ? TL_WEIGHT_POINT
           : light->method == TL_METHOD_AO   ? TL_WEIGHT_WHITE
                                             : TL_WEIGHT_POWER;
}

/* What lights follow from, the light's revision apart. */
static struct tl_kept_lights kept_lights(const tl_renderer *renderer, const struct tl_light_params *light)
{
    return (struct tl_kept_lights){.revision = renderer->light_revision,
                                   .regions = light->regions,
                                   .cut = light->cut,
                                   .weight = region_weight(light)};
}

static struct tl_kept_lights *find_lights(const tl_renderer *renderer, const struct tl_light_params *light)
{
    const struct tl_kept_lights sought = kept_lights(renderer, light);
    for (int i = 0; i < TL_LIGHTS_KEPT; i++) {
        const struct tl_kept_lights *kept = &renderer->kept[i];
        if (kept->revision == sought.revision && kept->regions == sought.regions && kept->cut == sought.cut &&
            kept->weight == sought.weight)
            return (struct tl_kept_lights *)kept;
    }
    return NULL;
}

bool tl_frame_has_lights(const tl_renderer *renderer, const struct tl_light_params *light)
{
    return find_lights(renderer, light) != NULL;
}

/* In the place of those that were used longest ago. */
static struct tl_kept_lights *make_lights(tl_renderer *renderer, const struct tl_light_params *light,
                                          const struct tl_regions *regions)
{
    struct tl_kept_lights *oldest = &renderer->kept[0];
    for (int i = 1; i < TL_LIGHTS_KEPT; i++)
        if (renderer->kept[i].used < oldest->used)
            oldest = &renderer->kept[i];
    tl_region_lights_release(&oldest->lights);
    *oldest = kept_lights(renderer, light);
    tl_region_lights_make(&oldest->lights, regions, oldest->weight, &renderer->lobes);
    oldest->used = ++renderer->kept_uses;
    return oldest;
}

void tl_frame_prepare_lights(tl_renderer *renderer, const struct tl_light_params *light)
{
    struct tl_regions regions = {0};
    if (light->cut == TL_CUT_SPHERE)
        tl_regions_cut_sphere(&renderer->cube, light->regions, &regions);
    else
        tl_regions_cut(&renderer->cube, light->regions, &regions);
    make_lights(renderer, light, &regions);
    tl_regions_release(&regions);
}

static bool run_lights(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    const struct tl_light_params *light = &renderer->settings.light;
    struct tl_kept_lights *kept = find_lights(renderer, light);
    if (!kept)
        kept = make_lights(renderer, light, &renderer->regions);
    kept->used = ++renderer->kept_uses;
    renderer->lights = &kept->lights;
    return true;
}

void tl_frame_list_surfaces(tl_renderer *renderer)
{
    const tl_frame *frame = &renderer->frame;
    renderer->drawn = tl_resize(renderer->drawn, frame->surface_count + 1,
                                sizeof *renderer->drawn); // NOLINT(bugprone-sizeof-expression): of a pointer
    for (size_t i = 0; i < frame->surface_count; i++)
        renderer->drawn[i] = &frame->surfaces[i];
    renderer->drawn[frame->surface_count] = &renderer->ground.surface;
    renderer->surface_count = frame->surface_count + (renderer->settings.image.ground ? 1 : 0);
    tl_triangle_ranges_make(renderer->drawn, renderer->surface_count, &renderer->ranges);
}

static bool run_surfaces(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    const tl_frame *frame = &renderer->frame;
    if (!tl_casters_measure(frame->surfaces, frame->surface_count, &renderer->casters, error))
        return false;
    tl_ground_make(&renderer->casters, &renderer->ground);
    tl_frame_list_surfaces(renderer);
    return tl_surfaces_update(renderer->surfaces, renderer->drawn, renderer->surface_count, error);
}

static bool run_detail(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    return tl_detail_maps_make(&renderer->detail, renderer->gpu, renderer->drawn, renderer->surface_count,
                               &renderer->settings.detail, error);
}

static struct tl_shadow_request shadow_request(const tl_renderer *renderer)
{
    const struct tl_light_params *light = &renderer->settings.light;
    bool in_passes = tl_light_source(light) == TL_LIGHT_CHAIN;
    const tl_bits moves_shadows = TL_BIT(TL_INPUT_MOTION) | TL_BIT(TL_INPUT_YAW);
    return (struct tl_shadow_request){
        .kind = (enum tl_visibility)light->visibility,
        .regions = &renderer->regions,
        .suns = &renderer->suns,
        .environment_yaw = renderer->frame.environment_yaw,
        .caster_surfaces = renderer->frame.surfaces,
        .caster_count = renderer->frame.surface_count,
        .casters = renderer->casters,
        .surfaces = renderer->surfaces,
        .surface_count = renderer->surface_count,
        .ground_index = renderer->settings.image.ground ? (int)renderer->surface_count - 1 : -1,
        .map_size = light->map_size,
        .maps_per_array = in_passes ? light->pems_per_pass : TL_REGIONS_MAX,
        .blur_m = light->blur_m,
        .regions_revision = renderer->regions_revision,
        /* What moves is followed a part at a time; what rests is brought up to date. */
        .refresh = renderer->moving & moves_shadows && !renderer->frame.still ? light->refresh : 0,
        .round = renderer->rest.image};
}

static bool run_maps(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    struct tl_shadow_request request = shadow_request(renderer);
    tl_shadow_maps_draw(renderer->maps, &request);
    return true;
}

static bool run_blur(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    struct tl_shadow_request request = shadow_request(renderer);
    tl_shadow_maps_blur(renderer->maps, &request);
    return true;
}

/* What no option asks for any more is not kept; bumps are as high as the options say, with maps or without.
 */
static void forget_unused_detail(tl_renderer *renderer)
{
    if (!(tl_frame_facts(&renderer->frame, &renderer->settings) & TL_BIT(TL_SCENE_DETAIL)))
        tl_detail_maps_release(&renderer->detail);
    renderer->detail.params = renderer->settings.detail;
}

static struct tl_gbuffer_request gbuffer_request(const tl_renderer *renderer)
{
    int width, height;
    tl_image_samples(&renderer->settings.image, &width, &height);
    return (struct tl_gbuffer_request){.view = &renderer->view,
                                       .width = width,
                                       .height = height,
                                       .surfaces = renderer->surfaces,
                                       .surface_count = renderer->surface_count,
                                       .ground = ground_of(renderer),
                                       .detail = &renderer->settings.detail,
                                       .frames = tl_frame_has(&renderer->frame, tl_material_is_faceted)};
}

static bool run_gbuffer(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    struct tl_gbuffer_request request = gbuffer_request(renderer);
    forget_unused_detail(renderer);
    return tl_gbuffer_draw(&renderer->gbuffer, renderer->gpu, &request, error);
}

static bool run_light(void *context, int level, tl_error *error)
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
                                             .ground = ground_of(renderer),
                                             .environment_yaw = renderer->frame.environment_yaw,
                                             .eye = renderer->view.eye,
                                             .round = renderer->rest.image,
                                             .params = &renderer->settings.light};
    return tl_lighting_draw(&renderer->lighting, renderer->gpu, &request, error);
}

static bool run_samples(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_samples_read(&renderer->gbuffer, &renderer->ranges, renderer->view.eye, &renderer->samples);
    return true;
}

static bool run_sheets(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    const struct tl_sheets_request request = {
        .gbuffer = &renderer->gbuffer, .draw = gbuffer_request(renderer), .ranges = &renderer->ranges};
    return tl_sheets_find(&renderer->sheets, renderer->gpu, &request, &renderer->samples, error);
}

/* Whoever asks the rays first in a frame brings them up to date; that costs nothing when they are. */
static bool follow_motion(tl_renderer *renderer, tl_error *error)
{
    return tl_trace_update(renderer->trace, renderer->frame.surfaces, renderer->frame.surface_count, error);
}

static bool run_mirrors(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    if (!follow_motion(renderer, error))
        return false;
    tl_mirrors_trace(&renderer->mirrors, renderer->trace, &renderer->ranges, ground_of(renderer),
                     &renderer->samples);
    return true;
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

static bool run_points(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    if (!follow_motion(renderer, error))
        return false;
    struct tl_points_request request = {.trace = renderer->trace,
                                        .ranges = &renderer->ranges,
                                        .samples = &renderer->samples,
                                        .regions = &renderer->regions,
                                        .suns = &renderer->suns,
                                        .regions_revision = renderer->regions_revision,
                                        .shapes_revision = renderer->signatures[TL_INPUT_SHAPES],
                                        .ground = ground_of(renderer),
                                        .environment_yaw = renderer->frame.environment_yaw,
                                        .params = &renderer->settings.light,
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
                                                    .ground = ground_of(renderer),
                                                    .eye = renderer->view.eye};
    if (request.lamp_count == 0 || renderer->samples.count == renderer->samples.primary_count)
        return true;
    if (request.shadowed && !follow_motion(renderer, error))
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

static bool run_compose(void *context, int level, tl_error *error)
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
    if (tl_frame_facts(&renderer->frame, &renderer->settings) & TL_BIT(TL_SCENE_SHEETS))
        request.shares = renderer->sheets.shares;
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

static bool run_envmap_lobes(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_cube_release(&renderer->surroundings.cube);
    tl_lobes_release(&renderer->surroundings.lobes);
    renderer->surroundings.cube = tl_cube_from_environment_with(
        renderer->frame.environment, renderer->settings.maps.size, &renderer->surroundings.pour);
    tl_lobes_make(&renderer->surroundings.lobes, &renderer->surroundings.cube,
                  tl_frame_map_exponents(&renderer->frame, &renderer->settings.detail));
    return true;
}

static mat3s environment_into_world(float yaw)
{
    mat3s axes = glms_mat3_identity();
    for (int i = 0; i < 3; i++)
        axes.col[i] = tl_turn_direction(axes.col[i], yaw);
    return axes;
}

static bool run_capture(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    const struct tl_maps_params *maps = &renderer->settings.maps;
    const struct tl_casters *casters = &renderer->casters;
    vec3s offset = {{maps->capture_at[0], maps->capture_at[1], maps->capture_at[2]}};
    mat3s into_world = environment_into_world(renderer->frame.environment_yaw);
    const struct tl_capture_request request = {
        .point = glms_vec3_add(casters->centre, offset),
        .size = maps->size,
        .environment = &renderer->surroundings.cube,
        .lobes = &renderer->surroundings.lobes,
        .environment_yaw = renderer->frame.environment_yaw,
        .into_world = &into_world,
        .exponents = tl_frame_map_exponents(&renderer->frame, &renderer->settings.detail),
        .exponent_levels = &renderer->lighting.exponent_levels,
        .surfaces = renderer->surfaces,
        .ranges = &renderer->ranges,
        .ground = ground_of(renderer),
        .near_m = 1e-3f * casters->radius,
        .far_m = glms_vec3_norm(offset) + 100 * casters->radius};
    return tl_capture_draw(&renderer->capture, renderer->gpu, &request, error);
}

static bool run_envmap(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    bool captured = renderer->settings.maps.capture_every > 0; /* in world axes */
    if (captured)                                              /* materials may have changed since */
        tl_lobes_make(&renderer->capture.lobes, &renderer->capture.cube,
                      tl_frame_map_exponents(&renderer->frame, &renderer->settings.detail));
    mat3s into_world = environment_into_world(captured ? 0 : renderer->frame.environment_yaw);
    tl_envmap_fill(&renderer->envmap, renderer->gpu, &renderer->settings.maps,
                   captured ? &renderer->capture.lobes : &renderer->surroundings.lobes, &into_world,
                   &renderer->view);
    tl_envmap_set_parts(&renderer->envmap, renderer->gpu, &renderer->ranges, renderer->settings.image.ground);
    return true;
}

static bool run_look_up(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    const tl_target *gbuffer = &renderer->gbuffer.target;
    const struct tl_envmap_request request = {.triangles = &gbuffer->colours[TL_GBUFFER_TRIANGLE],
                                              .exponent_levels = &renderer->lighting.exponent_levels,
                                              .eye = renderer->view.eye,
                                              .params = &renderer->settings.maps};
    tl_lighting_begin(&renderer->lighting, renderer->gpu, gbuffer, true);
    bool fine = tl_envmap_draw(&renderer->envmap, renderer->gpu, &request, error);
    tl_gpu_reset_state(renderer->gpu);
    return fine;
}

static bool run_lamp_maps(void *context, int level, tl_error *error)
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

static bool run_lamp_rays(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    if (!follow_motion(renderer, error))
        return false;
    struct tl_lamp lamps[TL_LAMPS_MAX];
    struct tl_lamp_shadows *shadows = &renderer->local.shadows;
    const struct tl_samples *samples = &renderer->samples;
    size_t count = list_lamps(renderer, lamps);
    uint8_t *visible = TL_NEW_ARRAY(uint8_t, (size_t)samples->width * (size_t)samples->height);
    for (size_t i = 0; i < count; i++) {
        if (shadows->kinds[i] != TL_LAMP_SHADOW_RAYS)
            continue;
        tl_lamp_rays(&lamps[i], renderer->trace, samples, &renderer->ranges, ground_of(renderer), visible);
        tl_lamp_shadows_set(shadows, renderer->gpu, samples->width, samples->height, i, count, visible);
    }
    free(visible);
    return true;
}

static bool run_lamps(void *context, int level, tl_error *error)
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
                                             .ground = ground_of(renderer),
                                             .casters = renderer->casters,
                                             .lamp_count = list_lamps(renderer, lamps),
                                             .lamps = lamps,
                                             .params = &renderer->settings.shading,
                                             .detail = &renderer->settings.detail,
                                             .depth_bias_m = renderer->settings.light.depth_bias_m,
                                             .weight = passes ? 1 / (float)(renderer->rest.image + 1) : 1};
    return tl_local_draw(&renderer->local, renderer->gpu, &request, error);
}

static bool run_reference(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    tl_image image;
    struct tl_reference_report report;
    tl_frame frame = renderer->frame;
    const struct tl_ground *ground = ground_of(renderer);
    tl_surface *surfaces =
        TL_NEW_ARRAY(tl_surface, frame.surface_count + 1); /* it wants the ground among them */
    memcpy(surfaces, frame.surfaces, frame.surface_count * sizeof *surfaces);
    frame.surfaces = surfaces;
    if (ground)
        surfaces[frame.surface_count++] = ground->surface;
    bool drawn = tl_reference_draw(&frame, &renderer->settings, ground, &image, &report, error);
    free(surfaces);
    if (!drawn)
        return false;
    tl_info("reference: %d replicates, %.3g million rays, standard error %.2g %%", report.replicates,
            1e-6 * (double)report.rays, 100 * report.standard_error);
    renderer->standard_error = report.standard_error;
    tl_present_set_image(&renderer->present, renderer->gpu, &image);
    tl_image_release(&image);
    return true;
}

static bool run_resolve(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    const struct tl_image_params *image = &renderer->settings.image;
    tl_present_resolve(&renderer->present, renderer->gpu, &renderer->lighting.target.colours[0],
                       &renderer->gbuffer.target.colours[TL_GBUFFER_POINT], image->width, image->height);
    return true;
}

static bool run_backdrop(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    return tl_present_set_backdrop(&renderer->present, renderer->gpu, renderer->frame.environment,
                                   &renderer->cube, renderer->settings.light.filter, error);
}

static bool run_show(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    const struct tl_show_request request = {.view = renderer->view,
                                            .environment_yaw = renderer->frame.environment_yaw,
                                            .params = &renderer->settings.image,
                                            .framebuffer = renderer->show_framebuffer,
                                            .width = renderer->show_width,
                                            .first_column = renderer->show_first,
                                            .end_column = renderer->show_end,
                                            .height = renderer->show_height};
    tl_present_show(&renderer->present, renderer->gpu, &request);
    return true;
}

/* Sets of resources. */
#define SET1(a)             TL_BIT(a)
#define SET2(a, b)          (SET1(a) | SET1(b))
#define SET3(a, b, c)       (SET2(a, b) | SET1(c))
#define SET4(a, b, c, d)    (SET2(a, b) | SET2(c, d))
#define SET5(a, b, c, d, e) (SET4(a, b, c, d) | SET1(e))
#define LEVELS_ONE                                                                                           \
    {                                                                                                        \
        "only"                                                                                               \
    }

const tl_job tl_frame_jobs[] = {
    {.name = "cube",
     .what = "environment to a cube map; its suns taken out",
     .reads = SET3(TL_INPUT_ENVIRONMENT, TL_INPUT_PEM_SIZE, TL_INPUT_SUN),
     .writes = SET1(TL_MADE_CUBE),
     .levels = LEVELS_ONE,
     .run = run_cube},
    {.name = "regions",
     .what = "the cube cut into regions",
     .reads = SET2(TL_MADE_CUBE, TL_INPUT_REGIONS),
     .writes = SET1(TL_MADE_REGIONS),
     .levels = LEVELS_ONE,
     .run = run_regions},
    {.name = "lobe",
     .what = "calibration of glossiness to chain level",
     .reads = SET2(TL_INPUT_PEM_SIZE, TL_INPUT_FILTER),
     .writes = SET1(TL_MADE_LOBE),
     .requires_scene = SET1(TL_SCENE_CHAINS),
     .levels = LEVELS_ONE,
     .run = run_lobe},
    {.name = "pems",
     .what = "a filtered copy of the cube for each region",
     .reads = SET4(TL_MADE_CUBE, TL_MADE_REGIONS, TL_INPUT_FILTER, TL_INPUT_PASSES),
     .writes = SET1(TL_MADE_PEMS),
     .requires_scene = SET1(TL_SCENE_CHAINS),
     .levels = LEVELS_ONE,
     .run = run_pems},
    {.name = "lobes",
     .what = "the whole environment through exact lobes",
     .reads = SET3(TL_MADE_CUBE, TL_INPUT_SHAPES, TL_INPUT_DETAIL),
     .writes = SET1(TL_MADE_LOBES),
     .requires_scene = SET1(TL_SCENE_EXACT),
     .levels = LEVELS_ONE,
     .run = run_lobes},
    {.name = "slices",
     .what = "the regions through exact lobes",
     .reads = SET4(TL_MADE_CUBE, TL_MADE_REGIONS, TL_INPUT_SHAPES, TL_INPUT_DETAIL),
     .writes = SET1(TL_MADE_SLICES),
     .requires_scene = SET1(TL_SCENE_SLICES),
     .levels = LEVELS_ONE,
     .run = run_slices},
    {.name = "lights",
     .what = "the regions as lights that add up to the exact light",
     .reads = SET3(TL_MADE_REGIONS, TL_MADE_LOBES, TL_INPUT_LIGHT),
     .writes = SET1(TL_MADE_LIGHTS),
     .requires_scene = SET2(TL_SCENE_RAYS, TL_SCENE_SHADOWS),
     .levels = LEVELS_ONE,
     .run = run_lights,
     .work = tl_lights_work},
    {.name = "surfaces",
     .what = "vertices and maps to the GPU",
     .reads = SET3(TL_INPUT_SHAPES, TL_INPUT_MOTION, TL_INPUT_GROUND),
     .writes = SET1(TL_MADE_SURFACES),
     .levels = LEVELS_ONE,
     .run = run_surfaces},
    {.name = "detail",
     .what = "heights, horizons and spread of normals of the fabrics",
     .reads = SET3(TL_INPUT_SHAPES, TL_INPUT_DETAIL, TL_INPUT_GROUND),
     .writes = SET1(TL_MADE_DETAIL),
     .requires_scene = SET1(TL_SCENE_DETAIL),
     .levels = LEVELS_ONE,
     .run = run_detail},
    {.name = "maps",
     .what = "a shadow map for each region and sun",
     .reads = SET5(TL_MADE_SURFACES, TL_MADE_REGIONS, TL_INPUT_YAW, TL_INPUT_MAPS, TL_INPUT_PASSES) |
              SET1(TL_INPUT_ROUND),
     .writes = SET1(TL_MADE_DEPTHS),
     .requires_scene = SET1(TL_SCENE_MAPS),
     .levels = LEVELS_ONE,
     .run = run_maps,
     .work = tl_maps_work},
    {.name = "blur",
     .what = "shadow maps blurred by the size of their regions",
     .reads = SET3(TL_MADE_DEPTHS, TL_MADE_REGIONS, TL_MADE_SURFACES),
     .writes = SET1(TL_MADE_MAPS),
     .requires_scene = SET2(TL_SCENE_MAPS, TL_SCENE_BLUR),
     .levels = LEVELS_ONE,
     .run = run_blur,
     .work = tl_maps_work},
    {.name = "gbuffer",
     .what = "nearest point, normal and material of every sample",
     .reads = SET5(TL_MADE_SURFACES, TL_MADE_DETAIL, TL_INPUT_CAMERA, TL_INPUT_SIZE, TL_INPUT_GROUND) |
              SET1(TL_INPUT_DETAIL),
     .writes = SET1(TL_MADE_GBUFFER),
     .levels = LEVELS_ONE,
     .run = run_gbuffer,
     .work = tl_gbuffer_work},
    {.name = "samples",
     .what = "the covered samples to the CPU",
     .reads = SET3(TL_MADE_GBUFFER, TL_INPUT_CAMERA, TL_INPUT_SHAPES),
     .writes = SET1(TL_MADE_SAMPLES),
     .requires_scene = SET1(TL_SCENE_SAMPLES),
     .levels = LEVELS_ONE,
     .run = run_samples,
     .work = tl_samples_work},
    {.name = "sheets",
     .what = "rays: what lies behind open cloth and shines through it",
     .reads = SET2(TL_MADE_SAMPLES, TL_MADE_SURFACES),
     .writes = SET1(TL_MADE_SHEETS),
     .requires_scene = SET1(TL_SCENE_SHEETS),
     .levels = LEVELS_ONE,
     .run = run_sheets,
     .work = tl_sample_rays_work},
    {.name = "mirrors",
     .what = "rays: what near mirrors show",
     .reads = SET5(TL_MADE_SAMPLES, TL_MADE_SHEETS, TL_INPUT_SHAPES, TL_INPUT_MOTION, TL_INPUT_GROUND),
     .writes = SET1(TL_MADE_MIRRORS),
     .requires_scene = SET1(TL_SCENE_MIRRORS),
     .levels = LEVELS_ONE,
     .run = run_mirrors,
     .work = tl_sample_rays_work},
    {.name = "points",
     .what = "rays: visibility of the regions, kept at vertices",
     .reads = SET5(TL_MADE_SAMPLES, TL_MADE_REGIONS, TL_INPUT_SHAPES, TL_INPUT_MOTION, TL_INPUT_GROUND) |
              SET5(TL_MADE_SHEETS, TL_MADE_MIRRORS, TL_INPUT_YAW, TL_INPUT_RAYS, TL_INPUT_SCENE_ROUND),
     .writes = SET1(TL_MADE_POINTS),
     .requires_scene = SET2(TL_SCENE_RAYS, TL_SCENE_SHADOWS),
     .levels = LEVELS_ONE,
     .run = run_points,
     .work = tl_points_work},
    {.name = "light",
     .what = "visibility times PEM, summed over the regions",
     .reads = SET5(TL_MADE_GBUFFER, TL_MADE_PEMS, TL_MADE_REGIONS, TL_MADE_LOBE, TL_MADE_MAPS) |
              SET5(TL_MADE_SURFACES, TL_INPUT_YAW, TL_INPUT_CAMERA, TL_INPUT_LIGHT, TL_INPUT_GROUND) |
              SET5(TL_MADE_LOBES, TL_MADE_SLICES, TL_MADE_DEPTHS, TL_INPUT_ROUND, TL_INPUT_LAMPS) |
              SET1(TL_INPUT_VIEW),
     .writes = SET1(TL_MADE_LIGHT),
     .requires_scene = SET1(TL_SCENE_PASSES),
     .levels = LEVELS_ONE,
     .run = run_light,
     .work = tl_passes_work},
    {.name = "compose",
     .what = "exact light times the share of it that is seen",
     .reads = SET5(TL_MADE_SAMPLES, TL_MADE_POINTS, TL_MADE_LIGHTS, TL_MADE_LOBES, TL_MADE_CUBE) |
              SET5(TL_MADE_SHEETS, TL_MADE_MIRRORS, TL_INPUT_YAW, TL_INPUT_LIGHT, TL_INPUT_CAMERA) |
              SET2(TL_INPUT_LAMPS, TL_INPUT_VIEW),
     .writes = SET1(TL_MADE_LIGHT),
     .requires_scene = SET1(TL_SCENE_COMPOSED),
     .levels = LEVELS_ONE,
     .run = run_compose,
     .work = tl_compose_work},
    {.name = "inspect",
     .what = "what a view shows in place of light",
     .reads = SET5(TL_MADE_SAMPLES, TL_MADE_POINTS, TL_MADE_REGIONS, TL_INPUT_MOTION, TL_INPUT_YAW) |
              SET1(TL_INPUT_VIEW),
     .writes = SET1(TL_MADE_LIGHT),
     .requires_scene = SET1(TL_SCENE_INSPECT),
     .levels = LEVELS_ONE,
     .run = tl_inspect_run,
     .work = tl_inspect_work},
    {.name = "envmap_lobes",
     .what = "all light through exact lobes, for environment maps",
     .reads = SET4(TL_INPUT_ENVIRONMENT, TL_INPUT_ENVMAP, TL_INPUT_SHAPES, TL_INPUT_DETAIL),
     .writes = SET1(TL_MADE_ENVMAP_LOBES),
     .requires_scene = SET1(TL_SCENE_ENVMAP),
     .levels = LEVELS_ONE,
     .run = run_envmap_lobes},
    /* What it draws is not among what it reads: what has changed since waits for the next capture. */
    {.name = "capture",
     .what = "the scene seen from a point, through exact lobes",
     .reads = SET1(TL_INPUT_CAPTURE),
     .writes = SET1(TL_MADE_CAPTURE),
     .requires_scene = SET2(TL_SCENE_ENVMAP, TL_SCENE_CAPTURE),
     .levels = LEVELS_ONE,
     .run = run_capture},
    {.name = "envmap",
     .what = "lobes poured into environment maps of a layout",
     .reads = SET5(TL_MADE_ENVMAP_LOBES, TL_INPUT_LAYOUT, TL_INPUT_YAW, TL_INPUT_SHAPES, TL_INPUT_GROUND) |
              SET1(TL_MADE_CAPTURE),
     .writes = SET1(TL_MADE_ENVMAP),
     .requires_scene = SET1(TL_SCENE_ENVMAP),
     .levels = LEVELS_ONE,
     .run = run_envmap},
    {.name = "look_up",
     .what = "environment maps looked up for every sample",
     .reads = SET5(TL_MADE_GBUFFER, TL_MADE_ENVMAP, TL_INPUT_CAMERA, TL_INPUT_LOOK_UP, TL_INPUT_LAMPS) |
              SET1(TL_INPUT_VIEW),
     .writes = SET1(TL_MADE_LIGHT),
     .requires_scene = SET1(TL_SCENE_ENVMAP),
     .levels = LEVELS_ONE,
     .run = run_look_up},
    /* Lamps add to the light in place, which is therefore made anew whenever they change. */
    {.name = "lamp_maps",
     .what = "a shadow map for each lamp",
     .reads = SET4(TL_MADE_SURFACES, TL_INPUT_LAMPS, TL_INPUT_MAPS, TL_INPUT_LIGHT),
     .writes = SET1(TL_MADE_LAMP_MAPS),
     .requires_scene = SET1(TL_SCENE_LAMP_MAPS),
     .levels = LEVELS_ONE,
     .run = run_lamp_maps,
     .work = tl_lamp_maps_work},
    {.name = "lamp_rays",
     .what = "rays: what is seen of each lamp",
     .reads = SET5(TL_MADE_SAMPLES, TL_MADE_SURFACES, TL_INPUT_MOTION, TL_INPUT_GROUND, TL_INPUT_LAMPS) |
              SET1(TL_INPUT_LIGHT),
     .writes = SET1(TL_MADE_LAMP_RAYS),
     .requires_scene = SET1(TL_SCENE_LAMP_RAYS),
     .levels = LEVELS_ONE,
     .run = run_lamp_rays,
     .work = tl_sample_rays_work},
    {.name = "lamps",
     .what = "light of the lamps, added",
     .reads = SET5(TL_MADE_LIGHT, TL_MADE_GBUFFER, TL_MADE_SURFACES, TL_MADE_LAMP_MAPS, TL_MADE_LAMP_RAYS) |
              SET4(TL_INPUT_CAMERA, TL_INPUT_LAMPS, TL_INPUT_GROUND, TL_INPUT_LIGHT),
     .writes = SET1(TL_MADE_LAMPLIGHT),
     .requires_scene = SET1(TL_SCENE_LAMPS),
     .levels = LEVELS_ONE,
     .run = run_lamps,
     .work = tl_lamps_work},
    {.name = "resolve",
     .what = "samples to pixels",
     .reads = SET4(TL_MADE_LIGHT, TL_MADE_LAMPLIGHT, TL_MADE_GBUFFER, TL_INPUT_SIZE),
     .writes = SET1(TL_MADE_IMAGE),
     .requires_scene = SET1(TL_SCENE_RASTER),
     .levels = LEVELS_ONE,
     .run = run_resolve,
     .work = tl_resolve_work},
    {.name = "reference",
     .what = "the image, ray traced",
     .reads = SET5(TL_INPUT_ENVIRONMENT, TL_INPUT_YAW, TL_INPUT_CAMERA, TL_INPUT_SIZE, TL_INPUT_LIGHT) |
              SET5(TL_MADE_SURFACES, TL_INPUT_GROUND, TL_INPUT_LAMPS, TL_INPUT_REFERENCE, TL_INPUT_VIEW),
     .writes = SET1(TL_MADE_IMAGE),
     .requires_scene = SET1(TL_SCENE_REFERENCE),
     .levels = LEVELS_ONE,
     .run = run_reference},
    {.name = "backdrop",
     .what = "the environment as it is seen behind",
     .reads = SET3(TL_INPUT_ENVIRONMENT, TL_MADE_CUBE, TL_INPUT_FILTER),
     .writes = SET1(TL_MADE_BACKDROP),
     .levels = LEVELS_ONE,
     .run = run_backdrop},
    {.name = "show",
     .what = "background, exposure, tone mapping",
     .reads = SET5(TL_MADE_IMAGE, TL_MADE_BACKDROP, TL_INPUT_SHOW, TL_INPUT_YAW, TL_INPUT_CAMERA),
     .writes = SET1(TL_MADE_SHOWN),
     .levels = LEVELS_ONE,
     .run = run_show},
};
const int tl_frame_job_count = (int)TL_COUNT(tl_frame_jobs);
