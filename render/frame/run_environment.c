/* Jobs that make light of the environment. */
#include "render/frame/run.h"

bool tl_run_cube(void *context, int level, tl_error *error)
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

bool tl_run_regions(void *context, int level, tl_error *error)
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

bool tl_run_lobes(void *context, int level, tl_error *error)
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
bool tl_run_slices(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_slices_release(&renderer->slices);
    tl_slices_make(&renderer->slices, &renderer->cube, &renderer->regions,
                   tl_frame_exponents(&renderer->frame, &renderer->settings.detail));
    tl_slice_maps_upload(&renderer->slice_maps, renderer->gpu, &renderer->slices);
    return true;
}

bool tl_run_lobe(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    struct tl_lobe_table table;
    tl_lobe_calibrate(renderer->settings.light.pem_size,
                      (enum tl_chain_filter)renderer->settings.light.filter, &table);
    tl_lighting_set_lobe(&renderer->lighting, renderer->gpu, &table);
    return true;
}

bool tl_run_pems(void *context, int level, tl_error *error)
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

bool tl_run_lights(void *context, int level, tl_error *error)
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

bool tl_run_backdrop(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    return tl_present_set_backdrop(&renderer->present, renderer->gpu, renderer->frame.environment,
                                   &renderer->cube, renderer->settings.light.filter, error);
}
