/* Jobs that draw surfaces: for shadows, and for the camera. */
#include "render/frame/facts.h"
#include "render/frame/job_io.h"

bool tl_run_surfaces(const struct tl_surfaces_job *job, tl_error *error)
{
    if (!tl_casters_measure(job->motion->surfaces, job->motion->surface_count, job->casters, error))
        return false;
    tl_ground_make(job->casters, job->ground_input->colour,
                   job->ground); /* the last of what is drawn, when it is drawn */
    tl_surfaces_use_derivatives(job->surfaces, job->detail_options->mode == TL_DETAIL_EYE_SPACE);
    return tl_surfaces_update(job->surfaces, job->shapes->drawn, job->shapes->drawn_count, error);
}

bool tl_run_detail(const struct tl_detail_job *job, tl_error *error)
{
    return tl_detail_maps_make(job->detail, job->gpu, job->shapes->drawn, job->shapes->drawn_count,
                               job->detail_steps, error);
}

/* The jobs that draw and that blur shadow maps make the same request. */
#define SHADOW_REQUEST(job)                                                                                  \
    (struct tl_shadow_request)                                                                               \
    {                                                                                                        \
        .kind = (enum tl_visibility)(job)->shadows->options.visibility,                                      \
        .moments = (enum tl_moments)(job)->shadows->options.moments, .regions = (job)->regions,              \
        .suns = (job)->suns, .environment_yaw = *(job)->yaw, .caster_surfaces = (job)->shapes->surfaces,     \
        .caster_count = (job)->shapes->surface_count, .casters = *(job)->casters,                            \
        .surfaces = (job)->surfaces, .surface_count = (job)->shapes->drawn_count,                            \
        .ground_index = (job)->ground_input->is_drawn ? (int)(job)->shapes->drawn_count - 1 : -1,            \
        .map_size = (job)->shadows->options.map_size,                                                        \
        .maps_per_array =                                                                                    \
            (job)->shadows->in_passes ? (job)->storage_options->pems_per_pass : TL_REGIONS_MAX,              \
        .blur_m = (job)->shadows->options.blur_m, .regions_revision = *(job)->regions_revision,              \
        .refresh = (job)->motion_state->moves_shadows && !(job)->motion_state->still                         \
                       ? (job)->rays->options.refresh                                                        \
                       : 0,                                                                                  \
        .round = *(job)->round                                                                               \
    }

/* While shadows move, as many maps a frame as light.refresh states; at rest all of them. */
bool tl_run_maps(const struct tl_maps_job *job, tl_error *error)
{
    (void)error;
    const struct tl_shadow_request request = SHADOW_REQUEST(job);
    tl_shadow_maps_draw(job->maps, &request);
    return true;
}

bool tl_run_blur(const struct tl_blur_job *job, tl_error *error)
{
    (void)error;
    const struct tl_shadow_request request = SHADOW_REQUEST(job);
    tl_shadow_maps_blur(job->maps, &request);
    return true;
}

/* The ground has an upper side only: from below it hides nothing. It is the last of what is drawn. */
#define SEEN_GROUND(job)                                                                                     \
    ((job)->ground_input->is_drawn && (job)->camera->view.eye.y > (job)->ground->centre.y ? (job)->ground    \
                                                                                          : NULL)
#define SEEN_COUNT(job)                                                                                      \
    ((job)->shapes->drawn_count - ((job)->ground_input->is_drawn && !SEEN_GROUND(job) ? 1 : 0))

/* The layers behind open cloth are drawn as the nearest one is. */
#define GBUFFER_REQUEST(job)                                                                                 \
    (struct tl_gbuffer_request)                                                                              \
    {                                                                                                        \
        .view = &(job)->shift->view, .width = (job)->size->columns, .height = (job)->size->rows,             \
        .surfaces = (job)->surfaces, .drawn = (job)->shapes->drawn, .surface_count = SEEN_COUNT(job),        \
        .ground = SEEN_GROUND(job), .detail = (job)->detail_steps,                                           \
        .blends_lobes = (job)->lobes_input->are_blended,                                                     \
        .frames =                                                                                            \
            (job)->lobes_input->all &&                                                                       \
            tl_materials_have((job)->shapes->surfaces, (job)->shapes->surface_count, tl_material_is_faceted) \
    }

bool tl_run_gbuffer(const struct tl_gbuffer_job *job, tl_error *error)
{
    const struct tl_gbuffer_request request = GBUFFER_REQUEST(job);
    return tl_gbuffer_draw(job->gbuffer, job->gpu, &request, error);
}

bool tl_run_ids(const struct tl_ids_job *job, tl_error *error)
{
    const struct tl_size_input *size = job->size;
    struct tl_gbuffer_request request = {.view = &job->shift->view,
                                         .width = size->columns,
                                         .height = size->rows,
                                         .surfaces = job->surfaces,
                                         .drawn = job->shapes->drawn,
                                         .surface_count = SEEN_COUNT(job),
                                         .ground = SEEN_GROUND(job),
                                         .only_triangle = true};
    if (!tl_ids_draw(job->ids, job->gpu, &request, &job->shapes->ranges, error))
        return false;
    request.width = size->options.width;
    request.height = size->options.height;
    return !tl_size_has_outlines(size) ||
           tl_ids_draw_nearest(job->pixel_ids, job->gpu, &request, &job->shapes->ranges, error);
}

bool tl_run_shade_materials(const struct tl_shade_materials_job *job, tl_error *error)
{
    (void)error;
    tl_shade_materials_make(job->shade_materials, job->shapes->drawn, job->shapes->drawn_count,
                            job->shapes->revision, job->detail_options, job->light_options->lobes);
    return true;
}

bool tl_run_samples(const struct tl_samples_job *job, tl_error *error)
{
    (void)error;
    tl_samples_read(job->gbuffer, &job->shapes->ranges, job->camera->view.eye, job->samples);
    return true;
}

bool tl_run_transparency(const struct tl_transparency_job *job, tl_error *error)
{
    const struct tl_transparency_request request = {
        .gbuffer = job->gbuffer, .draw = GBUFFER_REQUEST(job), .ranges = &job->shapes->ranges};
    return tl_transparency_find(job->transparency, job->gpu, &request, job->samples, error);
}

bool tl_run_trace(const struct tl_trace_job *job, tl_error *error)
{
    return tl_trace_update(job->trace, job->motion->surfaces, job->motion->surface_count, error);
}

bool tl_run_mirrors(const struct tl_mirrors_job *job, tl_error *error)
{
    (void)error;
    tl_mirrors_trace(job->mirrors, job->trace, &job->shapes->ranges,
                     job->ground_input->is_drawn ? job->ground : NULL, job->samples);
    return true;
}
