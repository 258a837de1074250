/* Counts and releases the memory of the resources. */
#include "render/frame/memory.h"

#include <stdlib.h>

static size_t no_bytes(const void *part)
{
    (void)part;
    return 0;
}

static void borrowed(const void *part)
{
    (void)part;
}

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

static size_t samples_bytes(const struct tl_samples *samples)
{
    return samples->capacity * sizeof *samples->items + samples->staging_bytes;
}

static size_t pixel_triangles_bytes(const struct tl_pixel_triangles *triangles)
{
    return triangles->capacity * sizeof *triangles->items;
}

static size_t region_slices_bytes(const struct tl_region_slices *slices)
{
    return tl_slice_maps_bytes(&slices->maps);
}

static void region_slices_release(struct tl_region_slices *slices)
{
    tl_slices_release(&slices->slices);
    tl_slice_maps_release(&slices->maps);
}

static size_t envmap_source_bytes(const struct tl_envmap_source *source)
{
    return cube_bytes(&source->cube) + tl_lobes_bytes(&source->lobes);
}

static void envmap_source_release(struct tl_envmap_source *source)
{
    tl_cube_release(&source->cube);
    tl_lobes_release(&source->lobes);
}

void tl_resources_release(struct tl_resources *all)
{
#define NOTHING(member, bit, type)
#define RELEASE(member, bit, type, bytes, release) release(&all->member);
    TL_MADE_RESOURCES(NOTHING, RELEASE, RELEASE)
    TL_OTHER_RESOURCES(NOTHING, RELEASE, RELEASE)
#undef RELEASE
    tl_triangle_ranges_release(&all->shapes.ranges);
    free(all->shapes.drawn);
    all->shapes.drawn = NULL;
}

static size_t lights_bytes(const struct tl_light_cache *cache)
{
    size_t bytes = 0;
    for (int i = 0; i < TL_LIGHTS_KEPT; i++)
        bytes += regions_bytes(&cache->kept[i].cut_regions) + tl_lobes_bytes(&cache->kept[i].lights.gain) +
                 tl_lobes_bytes(&cache->kept[i].lights.diffuse_gain);
    return bytes;
}

void tl_resources_count(const struct tl_resources *from, size_t bytes[TL_RESOURCE_COUNT])
{
    for (int i = 0; i < TL_RESOURCE_COUNT; i++)
        bytes[i] = 0;
#define COUNT(member, bit, type, count, release)        bytes[bit] += count(&from->member);
#define COUNT_HANDLE(member, bit, type, count, destroy) bytes[bit] += count(from->member);
    TL_MADE_RESOURCES(NOTHING, COUNT, COUNT_HANDLE)
#undef COUNT
#undef COUNT_HANDLE
    bytes[TL_MADE_LOBE] +=
        tl_texture_bytes(&from->lighting.exponent_levels) + tl_texture_bytes(&from->lighting.no_depths);
    bytes[TL_MADE_LOBES] +=
        tl_lobes_bytes(&from->light_cache.lobes) + tl_texture_bytes(&from->lighting.exact.lobes);
    bytes[TL_MADE_LIGHTS] += lights_bytes(&from->light_cache);
    bytes[TL_MADE_LAMP_MAPS] += tl_lamp_shadows_bytes(&from->local.shadows);
    bytes[TL_MADE_LAMPLIGHT] += tl_local_bytes(&from->local);
    bytes[TL_MADE_BACKDROP] += tl_backdrop_bytes(&from->present.backdrop);
}

size_t tl_resources_list(const struct tl_resources *from, struct tl_resource_memory out[TL_RESOURCES_MAX])
{
    size_t bytes[TL_RESOURCE_COUNT], count = 0;
    tl_resources_count(from, bytes);
    for (int i = 0; i < TL_RESOURCE_COUNT; i++)
        if (bytes[i] > 0)
            out[count++] = (struct tl_resource_memory){tl_resource_names[i], bytes[i]};
    return count;
}

struct tl_render_memory tl_resources_memory(const struct tl_resources *from)
{
    size_t bytes[TL_RESOURCE_COUNT];
    struct tl_render_memory memory = {0};
    tl_resources_count(from, bytes);
#define ADD(bit, name, use)                                                                                  \
    memory.use += bytes[bit];                                                                                \
    memory.total += bytes[bit];
    TL_MADE_BITS(ADD)
#undef ADD
    return memory;
}
