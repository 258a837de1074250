/* Jobs that make light of the environment. */
#include "assets/environment/adaptation.h"
#include "render/env/from_environment.h"
#include "render/frame/facts.h"
#include "render/frame/job_io.h"

bool tl_run_cube(const struct tl_cube_job *job, tl_error *error)
{
    (void)error;
    tl_cube_release(job->cube);
    tl_light_cache_begin(job->light_cache);
    tl_prepared *prepared = *job->prepared;
    bool fits = prepared && tl_prepared_fits(prepared, job->environment->revision, job->pem_options->pem_size,
                                             job->sun_options->sun);
    if (fits) {
        tl_prepared_give_cube(prepared, job->cube, job->suns);
        tl_prepared_give_lights(prepared, job->light_cache);
    }
    tl_prepared_destroy(job->prepared);
    if (fits)
        return true;
    *job->cube =
        tl_cube_from_environment_with(job->environment->map, job->pem_options->pem_size, job->resampling);
    *job->suns = (struct tl_suns){0};
    if (job->sun_options->sun)
        tl_suns_extract(job->cube, job->environment->map, job->suns);
    return true;
}

bool tl_run_regions(const struct tl_regions_job *job, tl_error *error)
{
    (void)error;
    const struct tl_regions *kept =
        tl_light_cache_regions(job->light_cache, job->cut_options->regions, job->cut_options->cut);
    if (kept) {
        tl_regions_release(job->regions);
        *job->regions = tl_regions_copy(kept);
    } else {
        tl_light_cut_regions(job->cube, job->cut_options->regions, job->cut_options->cut, job->regions);
    }
    ++*job->regions_revision;
    return true;
}

bool tl_run_lobes(const struct tl_lobes_job *job, tl_error *error)
{
    (void)error;
    struct tl_light_cache *cache = job->light_cache;
    const struct tl_shapes_input *shapes = job->shapes;
    tl_light_cache_need(cache, job->cube,
                        tl_exponents_of(shapes->surfaces, shapes->surface_count, job->detail_options));
    job->exact->lobes = &cache->lobes;
    job->exact->revision = cache->revision;
    return true;
}

/* Slices of other regions or of another cube cannot be reused. */
bool tl_run_slices(const struct tl_slices_job *job, tl_error *error)
{
    (void)error;
    const struct tl_shapes_input *shapes = job->shapes;
    tl_slices_release(&job->slices->slices);
    tl_slices_make(&job->slices->slices, job->cube, job->regions,
                   tl_exponents_of(shapes->surfaces, shapes->surface_count, job->detail_options));
    tl_slice_maps_upload(&job->slices->maps, job->gpu, &job->slices->slices);
    return true;
}

bool tl_run_lobe(const struct tl_lobe_job *job, tl_error *error)
{
    (void)error;
    struct tl_lobe_table table;
    tl_lobe_calibrate(job->pem_options->pem_size, (enum tl_chain_filter)job->filter_options->filter, &table);
    tl_lobe_levels_upload(job->lobe_levels, job->gpu, &table);
    return true;
}

bool tl_run_pems(const struct tl_pems_job *job, tl_error *error)
{
    (void)error;
    const struct tl_pem_storage storage = {job->storage_options->pems_per_pass,
                                           job->storage_options->pem_layout};
    tl_pems_build(job->pems, job->gpu, job->cube, job->regions, job->filter_options->filter, storage);
    return true;
}

bool tl_run_lights(const struct tl_lights_job *job, tl_error *error)
{
    (void)error;
    struct tl_light_cache *cache = job->light_cache;
    *job->lights = tl_light_cache_lights(cache, job->cut_options->regions, job->cut_options->cut,
                                         tl_light_region_weight(job->light_options), job->regions);
    cache->current = *job->lights;
    return true;
}

bool tl_run_backdrop(const struct tl_backdrop_job *job, tl_error *error)
{
    (void)error;
    const tl_environment *map = job->environment->map;
    struct tl_backdrop *backdrop = &job->present->backdrop;
    const vec3s ground = glms_vec3_mul(job->ground_input->colour, tl_adaptation_above(map));
    const vec3s *drawn = job->ground_input->is_drawn ? &ground : NULL;
    if (tl_image_floats(&map->backdrop)) {
        const tl_environment room = {.name = map->name, .layout = map->layout, .image = map->backdrop};
        tl_cube cube = tl_cube_from_environment(&room, job->pem_options->pem_size);
        tl_backdrop_set(backdrop, &cube, job->filter_options->filter, drawn);
        tl_cube_release(&cube);
    } else {
        tl_backdrop_set(backdrop, job->cube, job->filter_options->filter, drawn);
    }
    return true;
}
