#include "render/gbuffer/samples.h"

#include "config/base/memory.h"
#include "render/trace/trace.h"

#include <stdlib.h>

const tl_surface *tl_triangle_find(const struct tl_triangle_ranges *ranges, uint32_t number,
                                   uint32_t corners[3], size_t *surface)
{
    size_t s = 0;
    while (s + 1 < ranges->surface_count && number >= ranges->first[s + 1])
        s++;
    const uint32_t *indices = ranges->surfaces[s]->indices + 3 * (size_t)(number - ranges->first[s]);
    for (int i = 0; i < 3; i++)
        corners[i] = indices[i];
    *surface = s;
    return ranges->surfaces[s];
}

const struct tl_mesh_part *tl_triangle_part(const tl_surface *surface, uint32_t number)
{
    uint32_t index = 3 * number;
    size_t part = 0;
    while (part + 1 < surface->part_count &&
           index - surface->parts[part].first_index >= surface->parts[part].index_count)
        part++;
    return &surface->parts[part];
}

const tl_material *tl_triangle_material(const struct tl_triangle_ranges *ranges, uint32_t number)
{
    size_t s = 0;
    while (s + 1 < ranges->surface_count && number >= ranges->first[s + 1])
        s++;
    const tl_surface *surface = ranges->surfaces[s];
    return &surface->materials[tl_triangle_part(surface, number - ranges->first[s])->material];
}

void tl_triangle_ranges_make(const tl_surface *const *surfaces, size_t count, struct tl_triangle_ranges *out)
{
    out->surfaces = surfaces;
    out->surface_count = count;
    out->first = tl_resize(out->first, count + 1, sizeof(uint32_t));
    out->first[0] = 0;
    for (size_t i = 0; i < count; i++)
        out->first[i + 1] = out->first[i] + (uint32_t)(surfaces[i]->index_count / 3);
}

void tl_triangle_ranges_release(struct tl_triangle_ranges *ranges)
{
    free(ranges->first);
    *ranges = (struct tl_triangle_ranges){0};
}

vec3s tl_sample_start(const tl_sample *sample, const struct tl_triangle_ranges *ranges, float offset_m)
{
    uint32_t numbers[3];
    size_t index;
    const tl_surface *surface = tl_triangle_find(ranges, sample->triangle & ~TL_SAMPLE_BACK, numbers, &index);
    bool back = sample->triangle & TL_SAMPLE_BACK;
    vec3s corners[3], normals[3];
    for (int i = 0; i < 3; i++) {
        corners[i] = surface->positions[numbers[i]];
        normals[i] = surface->normals[numbers[i]];
        if (back)
            normals[i] = glms_vec3_negate(normals[i]);
    }
    vec3s point = tl_smooth_point(sample->point, corners, normals, sample->weights);
    return glms_vec3_add(point, glms_vec3_scale(sample->smooth, offset_m));
}

vec4s tl_sample_tangent(const tl_sample *sample, const struct tl_triangle_ranges *ranges)
{
    uint32_t numbers[3];
    size_t index;
    const tl_surface *surface = tl_triangle_find(ranges, sample->triangle & ~TL_SAMPLE_BACK, numbers, &index);
    vec4s sum = {{0, 0, 0, 0}};
    if (!surface->tangents)
        return (vec4s){{0, 0, 0, 1}};
    for (int i = 0; i < 3; i++)
        sum = glms_vec4_add(sum, glms_vec4_scale(surface->tangents[numbers[i]], sample->weights[i]));
    float length = glms_vec3_norm((vec3s){{sum.x, sum.y, sum.z}}), scale = length > 1e-15f ? 1 / length : 0;
    float side = sample->triangle & TL_SAMPLE_BACK ? -1.0f : 1.0f;
    return (vec4s){{scale * sum.x, scale * sum.y, scale * sum.z, side * sum.w}};
}

void tl_samples_reserve(struct tl_samples *samples, size_t count)
{
    if (count <= samples->capacity && samples->items)
        return;
    samples->capacity = tl_room_for(count, samples->capacity);
    samples->items = tl_resize(samples->items, samples->capacity, sizeof *samples->items);
}

void tl_samples_release(struct tl_samples *samples)
{
    free(samples->items);
    free(samples->staging);
    *samples = (struct tl_samples){0};
}
