/* Jobs that make light of the environment. */
#include "render/env/from_environment.h"
#include "render/frame/run.h"

bool tl_run_cube(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    tl_cube_release(&renderer->cube);
    tl_lobes_release(&renderer->lobes);
    renderer->light_revision++;
    renderer->exponents_sent = 0;
    if (tl_frame_use_prepared(renderer))
        return true;
    renderer->cube = tl_cube_from_environment_with(renderer->frame.environment,
                                                   renderer->settings.light.pem_size, &renderer->pour);
    renderer->suns = (struct tl_suns){0};
    if (renderer->settings.light.sun)
        tl_suns_extract(&renderer->cube, renderer->frame.environment, &renderer->suns);
    return true;
}

void tl_frame_cut_regions(const tl_cube *cube, const struct tl_light_params *light, struct tl_regions *out)
{
    if (light->cut == TL_CUT_SPHERE)
        tl_regions_cut_sphere(cube, light->regions, out);
    else
        tl_regions_cut(cube, light->regions, out);
}

/* All exponents, with all that is made of them, would be more than 100 MB. */
static void need_exponents(tl_renderer *renderer, uint32_t needed)
{
    if (needed == renderer->exponents)
        return;
    renderer->exponents_before = renderer->exponents;
    renderer->exponents = needed;
    uint32_t kept = needed | renderer->exponents_before;
    tl_lobes_keep(&renderer->lobes, kept);
    for (int i = 0; i < TL_LIGHTS_KEPT; i++)
        tl_lobes_keep(&renderer->kept[i].lights.gain, kept);
}

bool tl_run_lobes(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    need_exponents(renderer, tl_frame_exponents(&renderer->frame, &renderer->settings.detail));
    tl_lobes_make(&renderer->lobes, &renderer->cube, renderer->exponents);
    if (renderer->exponents_sent != renderer->lobes.made)
        tl_lighting_set_exact(&renderer->lighting, renderer->gpu, &renderer->lobes);
    renderer->exponents_sent = renderer->lobes.made;
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

enum tl_region_weight tl_frame_region_weight(const struct tl_light_params *light)
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
                                   .weight = tl_frame_region_weight(light)};
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

bool tl_run_regions(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    const struct tl_light_params *light = &renderer->settings.light;
    const struct tl_kept_lights *kept = find_lights(renderer, light);
    if (kept) {
        tl_regions_release(&renderer->regions);
        renderer->regions = tl_regions_copy(&kept->cut_regions);
    } else {
        tl_frame_cut_regions(&renderer->cube, light, &renderer->regions);
    }
    renderer->regions_revision++;
    return true;
}

bool tl_frame_has_lights(const tl_renderer *renderer, const struct tl_light_params *light)
{
    const struct tl_kept_lights *kept = find_lights(renderer, light);
    return kept && tl_region_lights_have(&kept->lights, renderer->exponents);
}

/* Not those that light the image. */
static struct tl_kept_lights *find_oldest(tl_renderer *renderer)
{
    struct tl_kept_lights *oldest = NULL;
    for (int i = 0; i < TL_LIGHTS_KEPT; i++) {
        struct tl_kept_lights *kept = &renderer->kept[i];
        if (&kept->lights != renderer->lights && (!oldest || kept->used < oldest->used))
            oldest = kept;
    }
    return oldest;
}

/* In the place of those that were used longest ago. */
static struct tl_kept_lights *replace_oldest(tl_renderer *renderer, const struct tl_light_params *light)
{
    struct tl_kept_lights *kept = find_oldest(renderer);
    tl_regions_release(&kept->cut_regions);
    tl_region_lights_release(&kept->lights);
    *kept = kept_lights(renderer, light);
    kept->used = ++renderer->kept_uses;
    return kept;
}

static struct tl_kept_lights *begin_lights(tl_renderer *renderer, const struct tl_light_params *light,
                                           const struct tl_regions *regions)
{
    struct tl_kept_lights *kept = replace_oldest(renderer, light);
    kept->cut_regions = tl_regions_copy(regions);
    tl_region_lights_begin(&kept->lights, regions, kept->weight);
    return kept;
}

void tl_frame_keep_lights(tl_renderer *renderer, const struct tl_light_params *light,
                          struct tl_regions *regions, struct tl_region_lights *lights)
{
    struct tl_kept_lights *same = find_lights(renderer, light);
    if (same) { /* which may have gains that are newer than these */
        tl_lobes_merge(&same->lights.gain, &lights->gain);
        tl_lobes_merge(&same->lights.diffuse_gain, &lights->diffuse_gain);
        return;
    }
    struct tl_kept_lights *kept = replace_oldest(renderer, light);
    kept->cut_regions = *regions;
    kept->lights = *lights;
    *regions = (struct tl_regions){0};
    *lights = (struct tl_region_lights){0};
}

/* Those kept, complete for what is drawn. */
static struct tl_kept_lights *complete_lights(tl_renderer *renderer, struct tl_kept_lights *kept)
{
    tl_region_lights_add(&kept->lights, &renderer->lobes, renderer->exponents);
    kept->used = ++renderer->kept_uses;
    return kept;
}

void tl_frame_prepare_lights(tl_renderer *renderer, const struct tl_light_params *light)
{
    struct tl_kept_lights *kept = find_lights(renderer, light);
    struct tl_regions regions = {0};
    if (!kept) {
        tl_frame_cut_regions(&renderer->cube, light, &regions);
        kept = begin_lights(renderer, light, &regions);
    }
    complete_lights(renderer, kept);
    tl_regions_release(&regions);
}

bool tl_run_lights(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level, (void)error;
    const struct tl_light_params *light = &renderer->settings.light;
    struct tl_kept_lights *kept = find_lights(renderer, light);
    if (!kept)
        kept = begin_lights(renderer, light, &renderer->regions);
    renderer->lights = &complete_lights(renderer, kept)->lights;
    return true;
}

bool tl_run_backdrop(void *context, int level, tl_error *error)
{
    tl_renderer *renderer = context;
    (void)level;
    return tl_present_set_backdrop(&renderer->present, renderer->gpu, renderer->frame.environment,
                                   &renderer->cube, renderer->settings.light.filter, error);
}
