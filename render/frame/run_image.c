/* Jobs of environment maps, of the reference, and of the image. */
#include "render/frame/run.h"

#include "config/log.h"
#include "render/env/from_environment.h"
#include "render/reference/reference.h"

bool tl_run_envmap_lobes(void *context, int level, tl_error *error)
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

bool tl_run_capture(void *context, int level, tl_error *error)
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
        .ground = tl_frame_ground(renderer),
        .near_m = 1e-3f * casters->radius,
        .far_m = glms_vec3_norm(offset) + 100 * casters->radius};
    return tl_capture_draw(&renderer->capture, renderer->gpu, &request, error);
}

bool tl_run_envmap(void *context, int level, tl_error *error)
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

bool tl_run_look_up(void *context, int level, tl_error *error)
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

bool tl_run_reference(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    tl_image image;
    struct tl_reference_report report;
    const struct tl_reference_request request =
        tl_frame_reference_request(&renderer->frame, &renderer->settings, tl_frame_ground(renderer));
    if (!tl_reference_draw(&request, &image, &report, error))
        return false;
    tl_info("reference: %d replicates, %.3g million rays, standard error %.2g %%", report.replicates,
            1e-6 * (double)report.rays, 100 * report.standard_error);
    renderer->standard_error = report.standard_error;
    tl_present_set_image(&renderer->present, renderer->gpu, &image);
    tl_image_release(&image);
    return true;
}

bool tl_run_resolve(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    const struct tl_image_params *image = &renderer->settings.image;
    tl_present_resolve(&renderer->present, renderer->gpu, &renderer->lighting.target.colours[0],
                       &renderer->gbuffer.target.colours[TL_GBUFFER_POINT], image->width, image->height);
    return true;
}

bool tl_run_show(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    const struct tl_show_request request = {.view = renderer->view,
                                            .environment_yaw = renderer->frame.environment_yaw,
                                            .params = &renderer->settings.image,
                                            .framebuffer = renderer->show_framebuffer,
                                            .width = renderer->show_width,
                                            .first_column = renderer->show_first,
                                            .end_column = renderer->show_end,
                                            .height = renderer->show_height};
    return tl_present_show(&renderer->present, renderer->gpu, &request, error);
}
