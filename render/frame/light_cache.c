#include "render/frame/light_cache.h"

void tl_light_cache_begin(struct tl_light_cache *cache)
{
    tl_lobes_release(&cache->lobes);
    cache->revision++;
    cache->current = NULL;
}

void tl_light_cache_release(struct tl_light_cache *cache)
{
    tl_lobes_release(&cache->lobes);
    for (int i = 0; i < TL_LIGHTS_KEPT; i++) {
        tl_regions_release(&cache->kept[i].cut_regions);
        tl_region_lights_release(&cache->kept[i].lights);
    }
    *cache = (struct tl_light_cache){0};
}

#define BLACK_REGIONS 6 /* one for each face: the cut of the cube makes no fewer */

void tl_light_cut_regions(const tl_cube *cube, int regions, int cut, struct tl_regions *out)
{
    if (tl_cube_is_black(cube) && regions > BLACK_REGIONS)
        regions = BLACK_REGIONS;
    if (cut == TL_CUT_SPHERE)
        tl_regions_cut_sphere(cube, regions, out);
    else
        tl_regions_cut(cube, regions, out);
}

enum tl_region_weight tl_light_region_weight(const struct tl_light_params *light)
{
    return light->method == TL_METHOD_LIGHTS ? TL_WEIGHT_POINT
           : light->method == TL_METHOD_AO   ? TL_WEIGHT_WHITE
                                             : TL_WEIGHT_POWER;
}

static void need_exponents(struct tl_light_cache *cache, uint32_t needed)
{
    if (needed == cache->exponents)
        return;
    cache->exponents_before = cache->exponents;
    cache->exponents = needed;
    uint32_t kept = needed | cache->exponents_before;
    tl_lobes_keep(&cache->lobes, kept);
    for (int i = 0; i < TL_LIGHTS_KEPT; i++)
        tl_lobes_keep(&cache->kept[i].lights.gain, kept);
}

void tl_light_cache_need(struct tl_light_cache *cache, const tl_cube *cube, uint32_t needed)
{
    need_exponents(cache, needed);
    tl_lobes_make(&cache->lobes, cube, needed);
}

static bool is_cut(const struct tl_light_cache *cache, const struct tl_kept_lights *kept, int regions,
                   int cut)
{
    return kept->revision == cache->revision && kept->regions == regions && kept->cut == cut;
}

const struct tl_regions *tl_light_cache_regions(const struct tl_light_cache *cache, int regions, int cut)
{
    for (int i = 0; i < TL_LIGHTS_KEPT; i++)
        if (is_cut(cache, &cache->kept[i], regions, cut))
            return &cache->kept[i].cut_regions;
    return NULL;
}

/* Index of the kept lights; -1: none. */
static int find(const struct tl_light_cache *cache, int regions, int cut, enum tl_region_weight weight)
{
    for (int i = 0; i < TL_LIGHTS_KEPT; i++)
        if (is_cut(cache, &cache->kept[i], regions, cut) && cache->kept[i].weight == weight)
            return i;
    return -1;
}

bool tl_light_cache_has(const struct tl_light_cache *cache, const struct tl_light_params *light)
{
    int found = find(cache, light->regions, light->cut, tl_light_region_weight(light));
    return found >= 0 && tl_region_lights_have(&cache->kept[found].lights, cache->exponents);
}

/* An entry in place of the one that was used longest ago, but not of the one that lights the image. */
static struct tl_kept_lights *replace_oldest(struct tl_light_cache *cache, int regions, int cut,
                                             enum tl_region_weight weight)
{
    struct tl_kept_lights *oldest = NULL;
    for (int i = 0; i < TL_LIGHTS_KEPT; i++) {
        struct tl_kept_lights *kept = &cache->kept[i];
        if (&kept->lights != cache->current && (!oldest || kept->used < oldest->used))
            oldest = kept;
    }
    tl_regions_release(&oldest->cut_regions);
    tl_region_lights_release(&oldest->lights);
    *oldest = (struct tl_kept_lights){
        .revision = cache->revision, .regions = regions, .cut = cut, .weight = weight, .used = ++cache->uses};
    return oldest;
}

const struct tl_region_lights *tl_light_cache_lights(struct tl_light_cache *cache, int region_count, int cut,
                                                     enum tl_region_weight weight,
                                                     const struct tl_regions *regions)
{
    int found = find(cache, region_count, cut, weight);
    struct tl_kept_lights *kept =
        found >= 0 ? &cache->kept[found] : replace_oldest(cache, region_count, cut, weight);
    if (found < 0) {
        kept->cut_regions = tl_regions_copy(regions);
        tl_region_lights_begin(&kept->lights, regions, weight);
    }
    tl_region_lights_add(&kept->lights, &cache->lobes, cache->exponents);
    kept->used = ++cache->uses;
    return &kept->lights;
}

void tl_light_cache_prepare(struct tl_light_cache *cache, const tl_cube *cube,
                            const struct tl_light_params *light)
{
    enum tl_region_weight weight = tl_light_region_weight(light);
    struct tl_regions regions = {0};
    if (find(cache, light->regions, light->cut, weight) < 0)
        tl_light_cut_regions(cube, light->regions, light->cut, &regions);
    tl_light_cache_lights(cache, light->regions, light->cut, weight, &regions);
    tl_regions_release(&regions);
}

void tl_light_cache_keep(struct tl_light_cache *cache, const struct tl_light_params *light,
                         struct tl_regions *regions, struct tl_region_lights *lights)
{
    enum tl_region_weight weight = tl_light_region_weight(light);
    int found = find(cache, light->regions, light->cut, weight);
    if (found >= 0) { /* its gains may be newer than these: only missing ones are taken */
        tl_lobes_merge(&cache->kept[found].lights.gain, &lights->gain);
        tl_lobes_merge(&cache->kept[found].lights.diffuse_gain, &lights->diffuse_gain);
        return;
    }
    struct tl_kept_lights *kept = replace_oldest(cache, light->regions, light->cut, weight);
    kept->cut_regions = *regions;
    kept->lights = *lights;
    *regions = (struct tl_regions){0};
    *lights = (struct tl_region_lights){0};
}
