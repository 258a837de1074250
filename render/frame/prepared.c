#include "render/frame/prepared.h"

#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/env/from_environment.h"
#include "render/frame/facts.h"

#include <stdlib.h>

struct tl_prepared {
    uint64_t environment_revision;
    struct tl_light_params light; /* as the renderer uses it */
    tl_cube cube;
    struct tl_suns suns;
    struct tl_lobes lobes;
    int count;
    struct tl_prepared_lights {
        int count;
        struct tl_regions regions;
        struct tl_region_lights lights;
    } lights[TL_PREPARED_COUNTS_MAX];
};

uint32_t tl_prepared_exponents(const tl_frame *frame, const struct tl_render_settings *settings)
{
    return tl_exponents_of(frame->surfaces, frame->surface_count, &settings->detail);
}

/* Whether every sample is lit from regions at these settings. */
static bool wants_lights(const struct tl_light_params *light)
{
    return light->visibility == TL_VISIBILITY_RAYS && light->method != TL_METHOD_REFERENCE &&
           light->method != TL_METHOD_UNSHADOWED && light->method != TL_METHOD_MAPS;
}

static void add_lights(tl_prepared *prepared, uint32_t exponents, int region_count)
{
    struct tl_regions *regions = &prepared->lights[prepared->count].regions;
    struct tl_region_lights *lights = &prepared->lights[prepared->count].lights;
    tl_light_cut_regions(&prepared->cube, region_count, prepared->light.cut, regions);
    tl_region_lights_begin(lights, regions, tl_light_region_weight(&prepared->light));
    tl_region_lights_add(lights, &prepared->lobes, exponents);
    prepared->lights[prepared->count++].count = region_count;
}

static void release_lights(tl_prepared *prepared, int i)
{
    tl_regions_release(&prepared->lights[i].regions);
    tl_region_lights_release(&prepared->lights[i].lights);
}

static bool is_requested(const struct tl_prepared_request *request, int region_count)
{
    for (int i = 0; i < TL_PREPARED_COUNTS_MAX; i++)
        if (request->region_counts[i] == region_count)
            return true;
    return false;
}

/* Keeps only the lights that are requested. Others would only displace them from the cache. */
static void keep_requested(tl_prepared *prepared, const struct tl_prepared_request *request)
{
    int kept = 0;
    for (int i = 0; i < prepared->count; i++) {
        const struct tl_prepared_lights lights = prepared->lights[i];
        if (!is_requested(request, lights.count))
            release_lights(prepared, i);
        prepared->lights[i] = (struct tl_prepared_lights){0}; /* the next user starts with an empty entry */
        if (is_requested(request, lights.count))
            prepared->lights[kept++] = lights;
    }
    prepared->count = kept;
}

static void need_lights(tl_prepared *prepared, uint32_t exponents, int region_count)
{
    for (int i = 0; i < prepared->count; i++)
        if (prepared->lights[i].count == region_count) {
            tl_region_lights_add(&prepared->lights[i].lights, &prepared->lobes, exponents);
            return;
        }
    add_lights(prepared, exponents, region_count);
}

/* One exponent at a time, so that a loader stops soon after it is interrupted. */
static void add_lobes(tl_prepared *prepared, uint32_t exponents, struct tl_progress *progress, int total)
{
    int done = 1;
    for (uint32_t left = exponents; left && !tl_interrupted(); left &= left - 1) {
        tl_lobes_make(&prepared->lobes, &prepared->cube, left & -left);
        tl_progress_update(progress, done++, total);
    }
}

static bool is_same_cube(const struct tl_light_params *a, const struct tl_light_params *b)
{
    return a->pem_size == b->pem_size && a->sun == b->sun;
}

static tl_prepared *begin(struct tl_prepared_request *request, const struct tl_light_params *light)
{
    tl_prepared *prepared = request->known;
    request->known = NULL;
    if (prepared && is_same_cube(&prepared->light, light)) {
        bool same_lights = prepared->light.cut == light->cut &&
                           tl_light_region_weight(&prepared->light) == tl_light_region_weight(light);
        keep_requested(prepared, same_lights ? request : &(const struct tl_prepared_request){0});
        prepared->light = *light;
        return prepared;
    }
    tl_prepared_destroy(&prepared);
    prepared = TL_NEW(tl_prepared);
    prepared->light = *light;
    prepared->cube = tl_cube_from_environment(request->environment, light->pem_size);
    if (light->sun)
        tl_suns_extract(&prepared->cube, request->environment, &prepared->suns);
    return prepared;
}

/* The number of regions that the renderer will cut. */
static void make_usable(struct tl_prepared_request *request)
{
    struct tl_render_settings settings = request->settings;
    for (int i = 0; i < TL_PREPARED_COUNTS_MAX; i++)
        if (request->region_counts[i] > 0) {
            settings.light.regions = request->region_counts[i];
            request->region_counts[i] = tl_render_settings_resolve(&settings).light.regions;
        }
}

tl_prepared *tl_prepared_make(struct tl_prepared_request *request)
{
    make_usable(request);
    const struct tl_render_settings used = tl_render_settings_resolve(&request->settings);
    const int lobe_count = __builtin_popcount(request->exponents), total = 1 + 2 * lobe_count;
    struct tl_progress progress = tl_progress_begin("prefiltering the light");
    tl_prepared *prepared = begin(request, &used.light);
    if (wants_lights(&used.light))
        add_lobes(prepared, request->exponents, &progress, total);
    for (int i = 0; wants_lights(&used.light) && i < TL_PREPARED_COUNTS_MAX && !tl_interrupted(); i++) {
        if (request->region_counts[i] > 0)
            need_lights(prepared, request->exponents, request->region_counts[i]);
        tl_progress_update(&progress, 1 + lobe_count * (1 + (i + 1.0) / TL_PREPARED_COUNTS_MAX), total);
    }
    tl_progress_end(&progress);
    return prepared;
}

static void copy_lights(tl_prepared *prepared, const struct tl_kept_lights *kept)
{
    struct tl_region_lights *copy = &prepared->lights[prepared->count].lights;
    prepared->lights[prepared->count].regions = tl_regions_copy(&kept->cut_regions);
    prepared->lights[prepared->count++].count = kept->regions;
    *copy = kept->lights;
    copy->gain = tl_lobes_copy(&kept->lights.gain);
    copy->diffuse_gain = tl_lobes_copy(&kept->lights.diffuse_gain);
}

tl_prepared *tl_prepared_copy_cache(const struct tl_light_cache *cache, const tl_cube *cube,
                                    const struct tl_suns *suns, const struct tl_light_params *light)
{
    tl_prepared *prepared = TL_NEW(tl_prepared);
    prepared->light = *light;
    prepared->cube = tl_cube_copy(cube);
    prepared->suns = *suns;
    prepared->lobes = tl_lobes_copy(&cache->lobes);
    for (int i = 0; i < TL_LIGHTS_KEPT; i++) {
        const struct tl_kept_lights *kept = &cache->kept[i];
        if (kept->revision == cache->revision && kept->cut == light->cut &&
            kept->weight == tl_light_region_weight(light))
            copy_lights(prepared, kept);
    }
    return prepared;
}

void tl_prepared_destroy(tl_prepared **prepared)
{
    if (!*prepared)
        return;
    tl_cube_release(&(*prepared)->cube);
    tl_lobes_release(&(*prepared)->lobes);
    for (int i = 0; i < (*prepared)->count; i++)
        release_lights(*prepared, i);
    free(*prepared);
    *prepared = NULL;
}

void tl_prepared_set_revision(tl_prepared *prepared, uint64_t environment_revision)
{
    prepared->environment_revision = environment_revision;
}

bool tl_prepared_fits(const tl_prepared *prepared, uint64_t environment_revision, int pem_size, bool sun)
{
    return prepared->environment_revision == environment_revision && prepared->light.pem_size == pem_size &&
           prepared->light.sun == sun;
}

void tl_prepared_give_lights(tl_prepared *prepared, struct tl_light_cache *cache)
{
    tl_lobes_merge(&cache->lobes, &prepared->lobes);
    /* The first counts matter most and are added last, so that no other displaces them. */
    for (int i = prepared->count - 1; i >= 0; i--) {
        prepared->light.regions = prepared->lights[i].count;
        tl_light_cache_keep(cache, &prepared->light, &prepared->lights[i].regions,
                            &prepared->lights[i].lights);
    }
}

void tl_prepared_give_cube(tl_prepared *prepared, tl_cube *cube, struct tl_suns *suns)
{
    *cube = prepared->cube;
    prepared->cube = (tl_cube){0};
    *suns = prepared->suns;
}
