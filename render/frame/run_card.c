/* Jobs of frames on the graphics card. */
#include "config/base/hash.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "render/frame/job_io.h"
#include "render/frame/settings.h"

bool tl_run_card_surfaces(const struct tl_card_surfaces_job *job, tl_error *error)
{
    const struct tl_card_surfaces request = {.ranges = &job->shapes->ranges,
                                             .shapes_revision = job->shapes->revision,
                                             .ground = job->ground_input->is_drawn ? job->ground : NULL,
                                             .materials = job->shade_materials};
    return tl_card_send_surfaces(job->card, &request, error);
}

/* Samples of a pixel along each side. There are never fewer samples than pixels: the card has the time. */
static int samples_of(const struct tl_size_input *size)
{
    return size->columns > size->options.width ? size->columns / size->options.width : 1;
}

bool tl_run_card_ids(const struct tl_card_ids_job *job, tl_error *error)
{
    const struct tl_card_view request = {.view = &job->shift->view,
                                         .width = samples_of(job->size) * job->size->options.width,
                                         .height = samples_of(job->size) * job->size->options.height};
    return tl_card_see(job->card, &request, error);
}

bool tl_run_card_points(const struct tl_card_points_job *job, tl_error *error)
{
    uint64_t hash = tl_hash(TL_HASH_START, job->regions_revision, sizeof *job->regions_revision);
    hash = tl_hash(hash, &job->shapes->revision, sizeof job->shapes->revision);
    hash = tl_hash(hash, &job->environment->revision, sizeof job->environment->revision);
    const struct tl_card_light request = {.regions = job->regions,
                                          .suns = job->suns,
                                          .lights = *job->lights,
                                          .lobes = job->exact->lobes,
                                          .light_revision =
                                              tl_hash(hash, job->light_options, sizeof *job->light_options),
                                          .environment_yaw = *job->yaw,
                                          .rays = job->rays->options.card_rays,
                                          .ground = job->ground_input->is_drawn ? job->ground : NULL,
                                          .lamps = job->lamps->items,
                                          .lamp_count = job->lamps->count};
    return tl_card_trace_points(job->card, &request, error);
}

bool tl_run_card_bounce(const struct tl_card_bounce_job *job, tl_error *error)
{
    const struct tl_card_bounce request = {.cube = job->cube,
                                           .cube_revision = job->environment->revision,
                                           .shares = job->light_options->bounce_shares};
    return tl_card_trace_bounce(job->card, &request, error);
}

bool tl_run_card_ratios(const struct tl_card_ratios_job *job, tl_error *error)
{
    return tl_card_make_ratios(job->card, *job->facts & TL_BIT(TL_SCENE_CARD_BOUNCE), error);
}

bool tl_run_card_suns(const struct tl_card_suns_job *job, tl_error *error)
{
    return tl_card_trace_suns(job->card, error);
}

bool tl_run_card_shade(const struct tl_card_shade_job *job, tl_error *error)
{
    struct tl_linear_image *image = &job->present->image;
    tl_linear_image_begin_gpu(image, job->gpu, job->size->options.width, job->size->options.height);
    return tl_card_shade(job->card, &image->target.colours[0], job->shift->before, error);
}

bool tl_run_card_rest(const struct tl_card_rest_job *job, tl_error *error)
{
    const struct tl_image_params *size = &job->size->options;
    struct tl_linear_image *image = &job->present->image;
    struct tl_card_rest request = {
        .environment = job->environment->map,
        .environment_revision = job->environment->revision,
        .environment_yaw = *job->yaw,
        .lamps = job->lamps->items,
        .lamp_count = job->lamps->count,
        .bounces = tl_frame_bounces(job->light_options, job->reference_options),
        .footprint = samples_of(job->size),
    };
    tl_linear_image_begin_gpu(image, job->gpu, size->width, size->height);
    struct tl_progress progress = tl_progress_begin("averaging");
    bool fine = true;
    for (int i = 0; fine && i < job->shift->rounds && !(i > 0 && tl_interrupted()); i++) {
        request.round = job->shift->before + i;
        const struct tl_view view =
            tl_frame_shifted_view(&job->camera->view, request.round, size->width, size->height);
        const struct tl_card_view seen = {.view = &view, .width = size->width, .height = size->height};
        fine = tl_card_see(job->card, &seen, error) &&
               tl_card_draw_round(job->card, &request, &image->target.colours[0], error);
        tl_progress_update(&progress, i + 1, job->shift->rounds);
    }
    tl_progress_end(&progress);
    return fine;
}
