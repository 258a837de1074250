/* Jobs of environment maps, of the reference, and of the image. */
#include "config/base/log.h"
#include "render/env/from_environment.h"
#include "render/frame/facts.h"
#include "render/frame/job_io.h"
#include "render/inspect/inspect.h"
#include "render/reference/reference.h"

bool tl_run_envmap_lobes(const struct tl_envmap_lobes_job *job, tl_error *error)
{
    (void)error;
    struct tl_envmap_source *made = job->envmap_source;
    tl_cube_release(&made->cube);
    tl_lobes_release(&made->lobes);
    made->cube = tl_cube_from_environment_with(job->environment->map, job->envmap_input->options.size,
                                               job->map_resampling);
    tl_lobes_make(
        &made->lobes, &made->cube,
        tl_map_exponents_of(job->shapes->surfaces, job->shapes->surface_count, job->detail_options));
    return true;
}

static mat3s environment_into_world(float yaw)
{
    mat3s axes = glms_mat3_identity();
    for (int i = 0; i < 3; i++)
        axes.col[i] = tl_turn_direction(axes.col[i], yaw);
    return axes;
}

bool tl_run_capture(const struct tl_capture_job *job, tl_error *error)
{
    const struct tl_maps_params *maps = job->capture_options;
    const struct tl_casters *casters = job->casters;
    const struct tl_shapes_input *shapes = job->shapes;
    vec3s offset = {{maps->capture_at[0], maps->capture_at[1], maps->capture_at[2]}};
    mat3s into_world = environment_into_world(*job->yaw);
    const struct tl_capture_request request = {
        .point = glms_vec3_add(casters->centre, offset),
        .size = maps->size,
        .environment = &job->envmap_source->cube,
        .lobes = &job->envmap_source->lobes,
        .environment_yaw = *job->yaw,
        .into_world = &into_world,
        .exponents = tl_map_exponents_of(shapes->surfaces, shapes->surface_count, job->detail_options),
        .exponent_levels = &job->lighting->exponent_levels,
        .surfaces = job->surfaces,
        .ranges = &shapes->ranges,
        .ground = job->ground_input->is_drawn ? job->ground : NULL,
        .casters = *casters,
        .lamps = job->lamps->items,
        .lamp_count = job->lamps->count,
        .near_m = 1e-3f * casters->radius,
        .far_m = glms_vec3_norm(offset) + 100 * casters->radius};
    return tl_capture_draw(job->capture, job->gpu, &request, error);
}

/* A captured scene is in world axes, the environment alone in its own. Materials may have changed since the
 * capture, and need lobes of other exponents. */
bool tl_run_envmap(const struct tl_envmap_job *job, tl_error *error)
{
    (void)error;
    bool captured = job->envmap_input->is_captured;
    const struct tl_shapes_input *shapes = job->shapes;
    if (captured)
        tl_lobes_make(&job->capture->lobes, &job->capture->cube,
                      tl_map_exponents_of(shapes->surfaces, shapes->surface_count, job->detail_options));
    mat3s into_world = environment_into_world(captured ? 0 : *job->yaw);
    tl_envmap_fill(job->envmap, job->gpu, job->layout_options,
                   captured ? &job->capture->lobes : &job->envmap_source->lobes, &into_world,
                   &job->camera->view);
    tl_envmap_set_parts(job->envmap, job->gpu, &shapes->ranges, job->ground_input->is_drawn);
    return true;
}

bool tl_run_light_map(const struct tl_light_map_job *job, tl_error *error)
{
    const tl_frame frame = {.surfaces = job->motion->surfaces,
                            .surface_count = job->shapes->surface_count,
                            .environment = job->environment->map,
                            .environment_yaw = *job->yaw};
    const struct tl_reference_request request = {.frame = &frame,
                                                 .ground = job->ground_input->is_drawn ? job->ground : NULL,
                                                 .params = job->reference_options,
                                                 .detail = job->detail_steps};
    return tl_light_map_bake(job->light_map, job->gpu, &request, job->envmap_input->options.light_map, error);
}

bool tl_run_look_up(const struct tl_look_up_job *job, tl_error *error)
{
    bool baked = job->look_up_options->light_map > 0;
    if (!baked)
        tl_light_map_release(job->light_map);
    else if (!tl_light_map_draw(job->light_map, job->gpu, &job->gbuffer->target, &job->shift->view,
                                job->surfaces, job->shapes->drawn_count, error))
        return false;
    const struct tl_envmap_request request = {.gbuffer = &job->gbuffer->target,
                                              .exponent_levels = &job->lighting->exponent_levels,
                                              .view = &job->shift->view,
                                              .surfaces = job->surfaces,
                                              .surface_count = job->shapes->drawn_count,
                                              .baked = baked ? &job->light_map->target.colours[0] : NULL,
                                              .params = job->look_up_options};
    bool fine = tl_envmap_draw(job->envmap, job->gpu, &request, job->light, error);
    tl_gpu_reset_state(job->gpu);
    return fine;
}

bool tl_run_reference(const struct tl_reference_job *job, tl_error *error)
{
    const tl_frame frame = {.camera = job->camera->camera,
                            .surfaces = job->motion->surfaces,
                            .surface_count = job->shapes->surface_count,
                            .environment = job->environment->map,
                            .environment_yaw = *job->yaw,
                            .lamps = job->lamps->items,
                            .lamp_count = job->lamps->count};
    const struct tl_render_settings settings = {.light = *job->light_options,
                                                .detail = *job->detail_steps,
                                                .image = job->size->options,
                                                .reference = *job->reference_options};
    const struct tl_reference_request request =
        tl_frame_reference_request(&frame, &settings, job->ground_input->is_drawn ? job->ground : NULL);
    tl_image image;
    struct tl_reference_report report;
    if (!tl_reference_draw(&request, &image, &report, error))
        return false;
    tl_info("reference: %d replicates, %.3g million rays, standard error %.2g %%", report.replicates,
            1e-6 * (double)report.rays, 100 * report.standard_error);
    *job->standard_error = report.standard_error;
    tl_present_set_image(job->present, &image);
    tl_image_release(&image);
    return true;
}

bool tl_run_inspect(const struct tl_inspect_job *job, tl_error *error)
{
    (void)error;
    tl_light_buffer_clear(job->light, job->samples->width, job->samples->height);
    *job->strain_range = tl_inspect_strain_range(job->view_options, job->shapes->drawn,
                                                 job->shapes->drawn_count, *job->strain_range);
    const struct tl_inspect_request request = {.image = job->view_options,
                                               .strain_range = *job->strain_range,
                                               .samples = job->samples,
                                               .ranges = &job->shapes->ranges,
                                               .regions = job->regions,
                                               .points = job->points,
                                               .view = &job->camera->view,
                                               .environment_yaw = *job->yaw};
    tl_inspect_paint(&request, job->light->texels);
    tl_light_buffer_finish(job->light, job->samples);
    return true;
}

bool tl_run_resolve(const struct tl_resolve_job *job, tl_error *error)
{
    (void)error;
    if (job->light->is_finished) {
        tl_present_resolve_texels(job->present, job->light->texels, job->size->columns, job->size->rows,
                                  job->size->options.width, job->size->options.height, job->shift->before);
        return true;
    }
    tl_present_resolve(job->present, job->gpu, &job->light->target.colours[0],
                       &job->gbuffer->target.colours[TL_GBUFFER_POINT], job->size->options.width,
                       job->size->options.height, job->shift->before);
    return true;
}

bool tl_run_show(const struct tl_show_job *job, tl_error *error)
{
    const struct tl_show_request request = {.view = job->camera->view,
                                            .environment_yaw = *job->yaw,
                                            .environment = job->environment->map,
                                            .params = job->show_options,
                                            .part = *job->show_part};
    return tl_present_show(job->present, job->gpu, &request, error);
}
