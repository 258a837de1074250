/* Jobs that draw surfaces: for shadows, and for the camera. */
#include "render/frame/run.h"

#include "config/memory.h"

const struct tl_ground *tl_frame_ground(const tl_renderer *renderer)
{
    return renderer->settings.image.ground ? &renderer->ground : NULL;
}

bool tl_frame_follow_motion(tl_renderer *renderer, tl_error *error)
{
    return tl_trace_update(renderer->trace, renderer->frame.surfaces, renderer->frame.surface_count, error);
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

bool tl_run_surfaces(void *context, int level, tl_error *error)
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

bool tl_run_detail(void *context, int level, tl_error *error)
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

bool tl_run_maps(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    struct tl_shadow_request request = shadow_request(renderer);
    tl_shadow_maps_draw(renderer->maps, &request);
    return true;
}

bool tl_run_blur(void *context, int level, tl_error *error)
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
                                       .drawn = renderer->drawn,
                                       .surface_count = renderer->surface_count,
                                       .ground = tl_frame_ground(renderer),
                                       .detail = &renderer->settings.detail,
                                       .frames = tl_frame_has(&renderer->frame, tl_material_is_faceted)};
}

bool tl_run_gbuffer(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    struct tl_gbuffer_request request = gbuffer_request(renderer);
    forget_unused_detail(renderer);
    return tl_gbuffer_draw(&renderer->gbuffer, renderer->gpu, &request, error);
}

bool tl_run_samples(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_samples_read(&renderer->gbuffer, &renderer->ranges, renderer->view.eye, &renderer->samples);
    return true;
}

bool tl_run_transparency(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    const struct tl_transparency_request request = {
        .gbuffer = &renderer->gbuffer, .draw = gbuffer_request(renderer), .ranges = &renderer->ranges};
    return tl_transparency_find(&renderer->transparency, renderer->gpu, &request, &renderer->samples, error);
}

bool tl_run_mirrors(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    if (!tl_frame_follow_motion(renderer, error))
        return false;
    tl_mirrors_trace(&renderer->mirrors, renderer->trace, &renderer->ranges, tl_frame_ground(renderer),
                     &renderer->samples);
    return true;
}
