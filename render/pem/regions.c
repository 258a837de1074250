#include "render/pem/regions.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static size_t texel_count(const struct tl_regions *regions)
{
    return 6 * (size_t)regions->size * (size_t)regions->size;
}

void tl_regions_release(struct tl_regions *regions)
{
    free(regions->labels);
    free(regions->solid_angles);
    free(regions->importance);
    free(regions->texels);
    free(regions->cumulative);
    *regions = (struct tl_regions){0};
}

static void *copy_of(const void *values, size_t count, size_t size)
{
    void *copy = tl_alloc(count, size);
    memcpy(copy, values, count * size);
    return copy;
}

struct tl_regions tl_regions_copy(const struct tl_regions *regions)
{
    struct tl_regions copy = *regions;
    size_t texels = texel_count(regions);
    copy.labels = copy_of(regions->labels, texels, sizeof *copy.labels);
    copy.solid_angles = copy_of(regions->solid_angles, texels / 6, sizeof *copy.solid_angles);
    copy.importance = copy_of(regions->importance, texels, sizeof *copy.importance);
    copy.texels = copy_of(regions->texels, texels, sizeof *copy.texels);
    copy.cumulative = copy_of(regions->cumulative, texels, sizeof *copy.cumulative);
    return copy;
}

/* The texel of region i at `u`: the first whose cumulative fraction exceeds u (binary search). */
static uint32_t place_of(const struct tl_regions *regions, int i, float u)
{
    uint32_t low = regions->first[i], high = regions->first[i + 1] - 1;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (regions->cumulative[middle] > u)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

vec3s tl_region_direction(const struct tl_regions *regions, int i, float u, float v)
{
    if (regions->first[i] == regions->first[i + 1])
        return regions->items[i].direction;
    uint32_t place = place_of(regions, i, u);
    float before = place > regions->first[i] ? regions->cumulative[place - 1] : 0;
    float share = regions->cumulative[place] - before;
    /* The position of u within the fraction of the texel is uniform again, and is used for the column. */
    float within = share > 0 ? fminf(fmaxf((u - before) / share, 0), 1) : 0.5f;
    int size = regions->size, texel = (int)regions->texels[place];
    int x = texel % size, line = texel / size;
    return glms_vec3_normalize(tl_cube_direction(line / size, ((float)x + within) / (float)size,
                                                 ((float)(line % size) + v) / (float)size));
}

/* `u` alone chooses the texel, so it must be even by itself: steps of the golden ratio are the evenest.
 * (Those of the plastic number, 0.7549 and 0.5698, are even in the square, but 0.7549 is nearly 3/4: sixteen
 * of them lie in four heaps.) `v` matters in a region of a few texels. Its step, that of the square root of
 * 3, is even in the square beside the other. Fixed point: exact at any n. */
vec3s tl_region_sample(const struct tl_regions *regions, int i, uint32_t n)
{
    const uint32_t step_u = 2654435769u, step_v = 3144134277u;
    uint32_t hash = ((uint32_t)i + 1) * 0x9e3779b1u;
    hash = (hash ^ hash >> 15) * 0x85ebca77u;
    const uint32_t u = hash + n * step_u, v = (hash ^ hash >> 13) * 0xc2b2ae3du + n * step_v;
    const float unit = 1.0f / (1 << 24);
    return tl_region_direction(regions, i, (float)(u >> 8) * unit, (float)(v >> 8) * unit);
}
