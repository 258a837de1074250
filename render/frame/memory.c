/* Counts the renderer's memory, resource by resource. */
#include "render/frame/memory.h"

static size_t cube_bytes(const tl_cube *cube)
{
    return 18 * sizeof(float) * (size_t)cube->size * (size_t)cube->size;
}

static size_t regions_bytes(const struct tl_regions *regions)
{
    size_t face = (size_t)regions->size * (size_t)regions->size;
    return face * (6 * (sizeof *regions->labels + sizeof *regions->importance + sizeof *regions->texels +
                        sizeof *regions->cumulative) +
                   sizeof *regions->solid_angles);
}

static size_t lights_bytes(const struct tl_light_cache *cache)
{
    size_t bytes = 0;
    for (int i = 0; i < TL_LIGHTS_KEPT; i++)
        bytes += regions_bytes(&cache->kept[i].cut_regions) + tl_lobes_bytes(&cache->kept[i].lights.gain) +
                 tl_lobes_bytes(&cache->kept[i].lights.diffuse_gain);
    return bytes;
}

static size_t samples_bytes(const struct tl_samples *samples)
{
    return samples->capacity * sizeof *samples->items + samples->staging_bytes;
}

static size_t resource_bytes(const struct tl_resources *from, enum tl_resource resource)
{
    const struct tl_present *present = &from->present;
    switch (resource) {
    case TL_MADE_CUBE:
        return cube_bytes(&from->cube);
    case TL_MADE_REGIONS:
        return regions_bytes(&from->regions);
    case TL_MADE_LOBE:
        return tl_texture_bytes(&from->lobe_levels) + tl_texture_bytes(&from->lighting.exponent_levels) +
               tl_texture_bytes(&from->exact.maps.lobes);
    case TL_MADE_PEMS:
        return tl_pems_bytes(&from->pems);
    case TL_MADE_LOBES:
        return tl_lobes_bytes(&from->light_cache.lobes);
    case TL_MADE_SLICES:
        return tl_slice_maps_bytes(&from->slices.maps);
    case TL_MADE_LIGHTS:
        return lights_bytes(&from->light_cache);
    case TL_MADE_SURFACES:
        return tl_surfaces_bytes(from->surfaces);
    case TL_MADE_DETAIL:
        return tl_detail_maps_bytes(&from->detail);
    case TL_MADE_DEPTHS:
        return tl_shadow_maps_bytes(from->maps);
    case TL_MADE_GBUFFER:
        return tl_gbuffer_bytes(&from->gbuffer);
    case TL_MADE_IDS:
        return tl_ids_bytes(&from->ids) + tl_ids_bytes(&from->pixel_ids);
    case TL_MADE_SHADE_MATERIALS:
        return tl_shade_materials_bytes(&from->shade_materials);
    case TL_MADE_RATIOS:
        return tl_ratios_bytes(&from->ratios);
    case TL_MADE_SUN_PIXELS:
        return tl_sun_pixels_bytes(&from->sun_pixels) +
               from->pixel_triangles.capacity * sizeof *from->pixel_triangles.items;
    case TL_MADE_SAMPLES:
        return samples_bytes(&from->samples);
    case TL_MADE_TRANSPARENCY:
        return tl_transparency_bytes(&from->transparency);
    case TL_MADE_POINTS:
        return tl_points_bytes(from->points);
    case TL_MADE_BOUNCE:
        return tl_bounce_bytes(&from->bounce);
    case TL_MADE_TRACE:
        return tl_trace_bytes(from->trace);
    case TL_MADE_ENVMAP_LOBES:
        return cube_bytes(&from->envmap_source.cube) + tl_lobes_bytes(&from->envmap_source.lobes);
    case TL_MADE_CAPTURE:
        return tl_capture_bytes(&from->capture);
    case TL_MADE_ENVMAP:
        return tl_envmap_bytes(&from->envmap);
    case TL_MADE_LIGHT_MAP:
        return tl_light_map_bytes(&from->light_map);
    case TL_MADE_LIGHT:
        return tl_light_buffer_bytes(&from->light);
    case TL_MADE_LAMP_MAPS:
        return tl_lamp_shadows_bytes(&from->local.shadows);
    case TL_MADE_LAMPLIGHT:
        return tl_local_bytes(&from->local);
    case TL_MADE_IMAGE:
        return tl_present_bytes(present);
    case TL_MADE_BACKDROP:
        return tl_backdrop_bytes(&present->backdrop);
    default:
        return 0;
    }
}

size_t tl_resources_list(const struct tl_resources *from, struct tl_resource_memory out[TL_RESOURCES_MAX])
{
    size_t count = 0;
    for (int i = TL_INPUT_COUNT; i < TL_RESOURCE_COUNT; i++) {
        size_t bytes = resource_bytes(from, (enum tl_resource)i);
        if (bytes > 0)
            out[count++] = (struct tl_resource_memory){tl_resource_names[i], bytes};
    }
    return count;
}

static size_t sum_of(const struct tl_resources *from, const enum tl_resource *resources, size_t count)
{
    size_t bytes = 0;
    for (size_t i = 0; i < count; i++)
        bytes += resource_bytes(from, resources[i]);
    return bytes;
}
#define SUM_OF(...)                                                                                          \
    sum_of(from, (const enum tl_resource[]){__VA_ARGS__},                                                    \
           sizeof((const enum tl_resource[]){__VA_ARGS__}) / sizeof(enum tl_resource))

struct tl_render_memory tl_resources_memory(const struct tl_resources *from)
{
    struct tl_render_memory memory = {
        .pems = SUM_OF(TL_MADE_PEMS, TL_MADE_LOBES, TL_MADE_LIGHTS, TL_MADE_SLICES, TL_MADE_ENVMAP_LOBES,
                       TL_MADE_ENVMAP, TL_MADE_LIGHT_MAP, TL_MADE_CAPTURE),
        .maps = SUM_OF(TL_MADE_DEPTHS, TL_MADE_LAMP_MAPS),
        .rays = SUM_OF(TL_MADE_POINTS, TL_MADE_BOUNCE, TL_MADE_RATIOS, TL_MADE_SUN_PIXELS, TL_MADE_TRACE,
                       TL_MADE_SAMPLES),
        .transparency = SUM_OF(TL_MADE_TRANSPARENCY),
        .targets = SUM_OF(TL_MADE_GBUFFER, TL_MADE_IDS, TL_MADE_LIGHT, TL_MADE_IMAGE),
        .surfaces = SUM_OF(TL_MADE_SURFACES, TL_MADE_DETAIL, TL_MADE_SHADE_MATERIALS),
        .other = SUM_OF(TL_MADE_CUBE, TL_MADE_REGIONS, TL_MADE_LOBE, TL_MADE_LAMPLIGHT, TL_MADE_BACKDROP)};
    memory.total = memory.pems + memory.maps + memory.rays + memory.transparency + memory.targets +
                   memory.surfaces + memory.other;
    return memory;
}
