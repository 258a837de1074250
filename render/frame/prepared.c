#include "render/frame/prepared.h"

#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"
#include "render/frame/frame.h"

#include <stdlib.h>

struct tl_prepared {
    uint64_t environment_revision;
    struct tl_light_params light; /* as the renderer uses it */
    tl_cube cube;
    struct tl_suns suns;
    struct tl_lobes lobes;
    int count;
    struct {
        int count;
        struct tl_regions regions;
        struct tl_region_lights lights;
    } lights[TL_PREPARED_COUNTS_MAX];
};

uint32_t tl_prepared_exponents(const tl_frame *frame, const struct tl_render_settings *settings)
{
    return tl_frame_exponents(frame, &settings->detail);
}

uint32_t tl_renderer_exponents(const tl_renderer *renderer)
{
    return renderer->exponents;
}

/* What is lit from regions at every sample. */
static bool wants_lights(const struct tl_light_params *light)
{
    return light->visibility == TL_VISIBILITY_RAYS && light->method != TL_METHOD_REFERENCE &&
           light->method != TL_METHOD_UNSHADOWED && light->method != TL_METHOD_MAPS;
}

static void add_lights(tl_prepared *prepared, const struct tl_prepared_request *request, int region_count)
{
    struct tl_render_settings settings = request->settings;
    settings.light.regions = region_count;
    const struct tl_light_params light = tl_frame_usable(&settings).light;
    struct tl_regions *regions = &prepared->lights[prepared->count].regions;
    struct tl_region_lights *lights = &prepared->lights[prepared->count].lights;
    tl_frame_cut_regions(&prepared->cube, &light, regions);
    tl_region_lights_begin(lights, regions, tl_frame_region_weight(&light));
    tl_region_lights_add(lights, &prepared->lobes, request->exponents);
    prepared->lights[prepared->count++].count = light.regions;
}

/* One exponent at a time, so that nobody waits long for a loader to stop. */
static void add_lobes(tl_prepared *prepared, uint32_t exponents, struct tl_progress *progress, int total)
{
    int done = 1;
    for (uint32_t left = exponents; left && !tl_interrupted(); left &= left - 1) {
        tl_lobes_make(&prepared->lobes, &prepared->cube, left & -left);
        tl_progress_update(progress, done++, total);
    }
}

tl_prepared *tl_prepared_make(const struct tl_prepared_request *request)
{
    tl_prepared *prepared = TL_NEW(tl_prepared);
    const struct tl_render_settings used = tl_frame_usable(&request->settings);
    const int lobe_count = __builtin_popcount(request->exponents), total = 1 + 2 * lobe_count;
    struct tl_progress progress = tl_progress_begin("prefiltering the light");
    prepared->light = used.light;
    prepared->cube = tl_cube_from_environment(request->environment, used.light.pem_size);
    if (used.light.sun)
        tl_suns_take(&prepared->cube, request->environment, &prepared->suns);
    if (wants_lights(&used.light))
        add_lobes(prepared, request->exponents, &progress, total);
    for (int i = 0; wants_lights(&used.light) && i < TL_PREPARED_COUNTS_MAX && !tl_interrupted(); i++) {
        if (request->region_counts[i] > 0)
            add_lights(prepared, request, request->region_counts[i]);
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

tl_prepared *tl_prepared_copy(const tl_renderer *renderer)
{
    if (renderer->cube.size == 0)
        return NULL;
    tl_prepared *prepared = TL_NEW(tl_prepared);
    prepared->light = renderer->settings.light;
    prepared->cube = tl_cube_copy(&renderer->cube);
    prepared->suns = renderer->suns;
    prepared->lobes = tl_lobes_copy(&renderer->lobes);
    for (int i = 0; i < TL_LIGHTS_KEPT; i++) {
        const struct tl_kept_lights *kept = &renderer->kept[i];
        if (kept->revision == renderer->light_revision && kept->cut == prepared->light.cut &&
            kept->weight == tl_frame_region_weight(&prepared->light))
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
    for (int i = 0; i < (*prepared)->count; i++) {
        tl_regions_release(&(*prepared)->lights[i].regions);
        tl_region_lights_release(&(*prepared)->lights[i].lights);
    }
    free(*prepared);
    *prepared = NULL;
}

void tl_renderer_take_prepared(tl_renderer *renderer, tl_prepared **prepared, uint64_t environment_revision)
{
    tl_prepared_destroy(&renderer->prepared);
    renderer->prepared = *prepared;
    renderer->prepared->environment_revision = environment_revision;
    *prepared = NULL;
}

static bool is_of_this_frame(const tl_prepared *prepared, const tl_renderer *renderer)
{
    const struct tl_light_params *light = &renderer->settings.light;
    return prepared->environment_revision == renderer->frame.environment_revision &&
           prepared->light.pem_size == light->pem_size && prepared->light.sun == light->sun;
}

static void use(tl_prepared *prepared, tl_renderer *renderer)
{
    renderer->cube = prepared->cube;
    prepared->cube = (tl_cube){0};
    renderer->suns = prepared->suns;
    tl_lobes_take(&renderer->lobes, &prepared->lobes);
    for (int i = 0; i < prepared->count; i++) {
        prepared->light.regions = prepared->lights[i].count;
        tl_frame_keep_lights(renderer, &prepared->light, &prepared->lights[i].regions,
                             &prepared->lights[i].lights);
    }
}

bool tl_frame_use_prepared(tl_renderer *renderer)
{
    bool fits = renderer->prepared && is_of_this_frame(renderer->prepared, renderer);
    if (fits)
        use(renderer->prepared, renderer);
    tl_prepared_destroy(&renderer->prepared);
    return fits;
}
