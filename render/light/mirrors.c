#include "render/light/mirrors.h"

#include "config/base/memory.h"
#include "render/brdf/facets.h"
#include "render/env/exponent.h"
#include "render/light/options.h"
#include "render/trace/cutout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SHARP_EXPONENT 1600.0f /* M s at least */

int tl_mirror_ray_count(float exponent)
{
    if (exponent < TL_MIRROR_EXPONENT)
        return 0;
    return (int)fminf(fmaxf(ceilf(SHARP_EXPONENT / exponent), 1), TL_MIRROR_RAYS_MAX);
}

vec3s tl_mirror_direction(vec3s axis, float exponent, int m, int count)
{
    const float golden_angle = 2.39996323f;
    if (count == 1)
        return axis;
    float share = ((float)m + 0.5f) / (float)count, angle = golden_angle * (float)m;
    float cosine = powf(1 - share, 1 / (exponent + 1)), sine = sqrtf(fmaxf(1 - cosine * cosine, 0));
    vec3s helper = fabsf(axis.y) < 0.9f ? (vec3s){{0, 1, 0}} : (vec3s){{1, 0, 0}};
    vec3s right = glms_vec3_normalize(glms_vec3_cross(helper, axis)), up = glms_vec3_cross(axis, right);
    vec3s side = glms_vec3_add(glms_vec3_scale(right, cosf(angle)), glms_vec3_scale(up, sinf(angle)));
    return glms_vec3_add(glms_vec3_scale(axis, cosine), glms_vec3_scale(side, sine));
}

/* A point of a triangle as it is seen along `direction`. */
static tl_sample seen_sample(const tl_surface *surface, uint32_t triangle, const float weights[3], bool back,
                             vec3s direction)
{
    const uint32_t *corners = surface->indices + 3 * (size_t)triangle;
    const tl_material *material = &surface->materials[tl_triangle_part(surface, triangle)->material];
    tl_sample sample = {.weights = {weights[0], weights[1], weights[2]}, .cover = 1 - material->openness};
    vec2s uv = {{0, 0}};
    for (int i = 0; i < 3; i++) {
        sample.point =
            glms_vec3_add(sample.point, glms_vec3_scale(surface->positions[corners[i]], weights[i]));
        sample.smooth =
            glms_vec3_add(sample.smooth, glms_vec3_scale(surface->normals[corners[i]], weights[i]));
        uv = glms_vec2_add(uv, glms_vec2_scale(surface->uvs[corners[i]], weights[i]));
    }
    sample.smooth = glms_vec3_normalize(back ? glms_vec3_negate(sample.smooth) : sample.smooth);
    sample.normal = sample.smooth;
    const vec3s viewer = glms_vec3_negate(direction);
    sample.mirror = mirror_direction(sample.normal, viewer);
    sample.glossiness = material->glossiness;
    vec3s f0 = glms_vec3_mul(material->specular, tl_map_colour_at(&material->specular_map, uv));
    sample.diffuse = glms_vec3_mul(material->diffuse, tl_map_colour_at(&material->diffuse_map, uv));
    if (back && material->back.is_given) {
        sample.diffuse = material->back.diffuse;
        f0 = material->back.specular;
    }
    sample.specular = schlick_colour(f0, glms_vec3_dot(sample.normal, viewer));
    return sample;
}

/* The samples that a block's rays hit, before they are appended to all samples. */
struct hit_block {
    size_t count, capacity;
    tl_sample *items;
};

static uint32_t keep(struct hit_block *block, const tl_sample *sample)
{
    if (block->count == block->capacity) {
        block->capacity = block->capacity ? 2 * block->capacity : 64;
        block->items = tl_resize(block->items, block->capacity, sizeof *block->items);
    }
    block->items[block->count] = *sample;
    return (uint32_t)block->count++;
}

struct mirror_scene {
    const tl_trace *trace;
    const struct tl_triangle_ranges *ranges;
    const struct tl_ground *ground;
};

/* Numbers within the block; TL_MIRROR_OPEN where the environment is seen. */
static uint32_t follow(const struct mirror_scene *scene, const tl_sample *sample, vec3s origin,
                       vec3s direction, struct hit_block *block)
{
    if (glms_vec3_dot(direction, sample->smooth) <= 0)
        return TL_MIRROR_BLACK;
    struct tl_trace_hit hit = tl_trace_nearest(scene->trace, origin, direction, 0, INFINITY);
    tl_sample seen;
    if (hit.surface != TL_TRACE_NONE) {
        const float weights[3] = {1 - hit.u - hit.v, hit.u, hit.v};
        seen = seen_sample(scene->ranges->surfaces[hit.surface], hit.triangle, weights, hit.back, direction);
        seen.triangle = (scene->ranges->first[hit.surface] + hit.triangle) | (hit.back ? TL_SAMPLE_BACK : 0);
    } else {
        uint32_t triangle;
        float weights[3];
        vec3s point;
        if (!tl_ground_meet(scene->ground, origin, direction, &point, &triangle, weights))
            return TL_MIRROR_OPEN;
        seen = seen_sample(&scene->ground->surface, triangle, weights, false, direction);
        seen.point = point;
        seen.triangle = scene->ranges->first[scene->ranges->surface_count - 1] + triangle;
        seen.cover = tl_ground_cover(scene->ground, point.x, point.z);
    }
    seen.texel = sample->texel;
    return keep(block, &seen);
}

/* A mirror in a mirror. */
static uint32_t follow_to_the_end(const struct mirror_scene *scene, const tl_sample *sample, vec3s origin,
                                  vec3s direction)
{
    bool open = glms_vec3_dot(direction, sample->smooth) > 0 &&
                tl_ground_visibility(scene->ground, origin, direction) > 0.5f &&
                !tl_trace_occluded(scene->trace, origin, direction, 0, INFINITY);
    return open ? TL_MIRROR_OPEN : TL_MIRROR_BLACK;
}

/* `block` NULL: of a sample that is shown by a mirror itself. */
static void trace_sample(const struct mirror_scene *scene, const tl_sample *sample, float offset_m,
                         struct hit_block *block, struct tl_mirror *mirror)
{
    float exponent = tl_lobe_exponent(sample->glossiness);
    mirror->ray_count = tl_mirror_ray_count(exponent);
    if (mirror->ray_count == 0)
        return;
    vec3s origin = tl_sample_start(sample, scene->ranges, offset_m);
    for (int m = 0; m < mirror->ray_count; m++) {
        vec3s direction = tl_mirror_direction(sample->mirror, exponent, m, mirror->ray_count);
        mirror->directions[m] = direction;
        mirror->hits[m] = block ? follow(scene, sample, origin, direction, block)
                                : follow_to_the_end(scene, sample, origin, direction);
    }
}

static void reserve(struct tl_mirrors *mirrors, size_t count)
{
    if (count <= mirrors->capacity && mirrors->items)
        return;
    mirrors->capacity = tl_room_for(count, mirrors->capacity);
    mirrors->items = tl_resize(mirrors->items, mirrors->capacity, sizeof *mirrors->items);
}

/* Behind the camera's samples, block by block; numbers within blocks become indices. */
static void append(struct tl_mirrors *mirrors, struct hit_block *blocks, size_t block_count,
                   size_t block_size, struct tl_samples *samples)
{
    size_t seen = tl_samples_seen(samples), total = seen;
    for (size_t b = 0; b < block_count; b++) {
        size_t end = (b + 1) * block_size < seen ? (b + 1) * block_size : seen;
        for (size_t i = b * block_size; i < end; i++)
            for (int m = 0; m < mirrors->items[i].ray_count; m++)
                if (mirrors->items[i].hits[m] < TL_MIRROR_BLACK)
                    mirrors->items[i].hits[m] += (uint32_t)total;
        total += blocks[b].count;
    }
    tl_samples_reserve(samples, total);
    samples->count = seen;
    for (size_t b = 0; b < block_count; b++) {
        if (blocks[b].count > 0)
            memcpy(samples->items + samples->count, blocks[b].items, blocks[b].count * sizeof(tl_sample));
        samples->count += blocks[b].count;
        free(blocks[b].items);
    }
}

void tl_mirrors_trace(struct tl_mirrors *mirrors, const tl_trace *trace,
                      const struct tl_triangle_ranges *ranges, const struct tl_ground *ground,
                      struct tl_samples *samples)
{
    const size_t block_size = 1024;
    size_t count = tl_samples_seen(samples), block_count = (count + block_size - 1) / block_size;
    const struct mirror_scene scene = {trace, ranges, ground};
    float offset_m = tl_trace_offset(trace);
    reserve(mirrors, count);
    struct hit_block *blocks = TL_NEW_ARRAY(struct hit_block, block_count);
#pragma omp parallel for schedule(dynamic)
    for (size_t b = 0; b < block_count; b++)
        for (size_t i = b * block_size; i < count && i < (b + 1) * block_size; i++)
            trace_sample(&scene, &samples->items[i], offset_m, &blocks[b], &mirrors->items[i]);
    append(mirrors, blocks, block_count, block_size, samples);
    free(blocks);
    reserve(mirrors, samples->count);
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t i = count; i < samples->count; i++)
        trace_sample(&scene, &samples->items[i], offset_m, NULL, &mirrors->items[i]);
}

void tl_mirrors_release(struct tl_mirrors *mirrors)
{
    free(mirrors->items);
    *mirrors = (struct tl_mirrors){0};
}
