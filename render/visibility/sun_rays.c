#include "render/visibility/sun_rays.h"

#include "config/base/memory.h"
#include "render/visibility/maps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BUNDLE 16 /* rays */
#define BLOCK  64 /* bundles that a thread takes at a time */
#define MORE   8  /* rays for a doubtful sample */
/* Samples beside the edge of a shadow get more rays: their neighbours are a square of 2 REACH + 1 a side. */
#define REACH 2

enum { DARK = 1, LIT = 2 };

static void reserve(struct tl_sun_rays *rays, const struct tl_points_request *request)
{
    const struct tl_samples *samples = request->samples;
    size_t texel_count = (size_t)samples->width * (size_t)samples->height;
    if (samples->count > rays->capacity) {
        rays->capacity = tl_room_for(samples->count, rays->capacity);
        for (int i = 0; i < TL_SUNS_MAX; i++) {
            free(rays->visible[i]);
            rays->visible[i] = NULL;
        }
        free(rays->seen);
        rays->seen = TL_NEW_ARRAY(float, rays->capacity);
        free(rays->doubtful);
        rays->doubtful = TL_NEW_ARRAY(uint32_t, rays->capacity);
    }
    for (int i = 0; i < rays->count; i++)
        if (!rays->visible[i])
            rays->visible[i] = TL_NEW_ARRAY(float, rays->capacity);
    if (texel_count > rays->texel_capacity) {
        rays->texel_capacity = texel_count;
        free(rays->marks);
        free(rays->spread);
        rays->marks = TL_NEW_ARRAY(uint8_t, texel_count);
        rays->spread = TL_NEW_ARRAY(uint8_t, texel_count);
    }
}

/* Traces the visibility of a point of the sun at `count` samples; samples below whose horizon it lies are
 * left at -1. Returns the number of rays. */
static size_t trace_samples(const struct tl_points_request *request, const struct tl_ray_origins *origins,
                            const uint32_t samples[BUNDLE], int count, vec3s direction, float seen[BUNDLE])
{
    struct tl_ray_packet bundle = {.to_m = INFINITY, .coherent = true};
    int place[BUNDLE];
    for (int i = 0; i < count; i++) {
        vec3s start = origins->points[samples[i]];
        seen[i] = -1;
        if (glms_vec3_dot(request->samples->items[samples[i]].smooth, direction) <= 0)
            continue;
        seen[i] = tl_ground_visibility(request->ground, start, direction);
        if (seen[i] <= 0)
            continue;
        int k = bundle.count++;
        place[k] = i;
        bundle.origin_x[k] = start.x, bundle.origin_y[k] = start.y, bundle.origin_z[k] = start.z;
        bundle.direction_x[k] = direction.x;
        bundle.direction_y[k] = direction.y;
        bundle.direction_z[k] = direction.z;
    }
    if (bundle.count == 0)
        return 0;
    float through[BUNDLE];
    tl_trace_transmittance_packet(request->trace, &bundle, through);
    for (int k = 0; k < bundle.count; k++)
        seen[place[k]] *= through[k];
    return (size_t)bundle.count;
}

/* The place of the sun that ray `k` of a round goes to. */
static vec3s place_of(const struct tl_points_request *request, int sun, int round, int k)
{
    const struct tl_sun *item = &request->suns->items[sun];
    vec3s place = item->sample_count > 0 ? item->samples[((1 + MORE) * round + k) % item->sample_count]
                                         : item->direction;
    return tl_turn_direction(place, request->environment_yaw);
}

/* One ray a sample; marks what it sees. */
static size_t trace_first(struct tl_sun_rays *rays, const struct tl_points_request *request,
                          const struct tl_ray_origins *origins, int sun)
{
    size_t count = request->samples->count, ray_count = 0;
    vec3s direction = place_of(request, sun, rays->rounds, 0);
    memset(rays->marks, 0, (size_t)request->samples->width * (size_t)request->samples->height);
#pragma omp parallel for schedule(dynamic, BLOCK) reduction(+ : ray_count)
    for (size_t first = 0; first < count; first += BUNDLE) {
        uint32_t samples[BUNDLE];
        int size = count - first < BUNDLE ? (int)(count - first) : BUNDLE;
        for (int i = 0; i < size; i++)
            samples[i] = (uint32_t)first + (uint32_t)i;
        float *seen = rays->seen + first;
        ray_count += trace_samples(request, origins, samples, size, direction, seen);
        for (int i = 0; i < size; i++) {
            /* Samples whose horizon hides the sun take no part: their share is zero. */
            if (seen[i] >= 0 && first + (size_t)i < request->samples->primary_count)
                rays->marks[request->samples->items[first + (size_t)i].texel] = seen[i] > 0.5f ? LIT : DARK;
            seen[i] = fmaxf(seen[i], 0);
        }
    }
    return ray_count;
}

/* Spreads the bits of a row of `width` marks over REACH texels to both sides. */
static void spread_along(const uint8_t *marks, uint8_t *out, int width)
{
    memcpy(out, marks, (size_t)width);
    for (int shift = 1; shift <= REACH; shift++)
        for (int x = shift; x < width; x++) {
            out[x] |= marks[x - shift];
            out[x - shift] |= marks[x];
        }
}

/* ... and over as many rows above and below. */
static void spread_across(const uint8_t *marks, uint8_t *out, int width, int height, int y)
{
    int first = y > REACH ? y - REACH : 0, last = y + REACH < height ? y + REACH : height - 1;
    memset(out, 0, (size_t)width);
    for (int row = first; row <= last; row++)
        for (int x = 0; x < width; x++)
            out[x] |= marks[(size_t)row * (size_t)width + (size_t)x];
}

/* Lists the samples in whose neighbourhood some see the sun and some do not, and those that have seen a part
 * of it in earlier rounds; returns how many. */
static size_t find_doubtful(struct tl_sun_rays *rays, const struct tl_samples *samples, int sun)
{
    int width = samples->width, height = samples->height;
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++)
        spread_along(rays->marks + (size_t)y * (size_t)width, rays->spread + (size_t)y * (size_t)width,
                     width);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++)
        spread_across(rays->spread, rays->marks + (size_t)y * (size_t)width, width, height, y);
    size_t count = 0;
    for (size_t i = 0; i < samples->count; i++) {
        float mean = rays->visible[sun][i];
        bool partly = rays->rounds > 0 && mean > 0 && mean < 1;
        if (partly || rays->marks[samples->items[i].texel] == (DARK | LIT))
            rays->doubtful[count++] = (uint32_t)i;
    }
    return count;
}

/* Traces more rays for the doubtful samples, whose visibility becomes the mean of all rays. */
static size_t trace_doubtful(struct tl_sun_rays *rays, const struct tl_points_request *request,
                             const struct tl_ray_origins *origins, int sun, size_t doubtful_count)
{
    size_t ray_count = 0;
    int places = request->suns->items[sun].sample_count, more = places - 1 < MORE ? places - 1 : MORE;
#pragma omp parallel for schedule(dynamic, BLOCK) reduction(+ : ray_count)
    for (size_t first = 0; first < doubtful_count; first += BUNDLE) {
        const uint32_t *samples = rays->doubtful + first;
        int size = doubtful_count - first < BUNDLE ? (int)(doubtful_count - first) : BUNDLE;
        for (int k = 1; k <= more; k++) {
            float seen[BUNDLE];
            ray_count +=
                trace_samples(request, origins, samples, size, place_of(request, sun, rays->rounds, k), seen);
            for (int i = 0; i < size; i++)
                rays->seen[samples[i]] += fmaxf(seen[i], 0);
        }
        for (int i = 0; i < size; i++)
            rays->seen[samples[i]] /= (float)(1 + (more > 0 ? more : 0));
    }
    return ray_count;
}

size_t tl_sun_rays_update(struct tl_sun_rays *rays, const struct tl_points_request *request,
                          const struct tl_ray_origins *origins, bool again)
{
    again = again && rays->count == request->suns->count;
    if (!again)
        rays->rounds = 0;
    rays->count = request->suns->count;
    if (rays->rounds >= request->params->rounds)
        return 0;
    reserve(rays, request);
    size_t ray_count = 0;
    for (int sun = 0; sun < rays->count; sun++) {
        ray_count += trace_first(rays, request, origins, sun);
        ray_count += trace_doubtful(rays, request, origins, sun, find_doubtful(rays, request->samples, sun));
        for (size_t i = 0; i < request->samples->count; i++) {
            float *mean = &rays->visible[sun][i];
            *mean += (rays->seen[i] - *mean) / (float)(rays->rounds + 1);
        }
    }
    rays->rounds++;
    return ray_count;
}

void tl_sun_rays_release(struct tl_sun_rays *rays)
{
    for (int i = 0; i < TL_SUNS_MAX; i++)
        free(rays->visible[i]);
    free(rays->seen);
    free(rays->marks);
    free(rays->spread);
    free(rays->doubtful);
    *rays = (struct tl_sun_rays){0};
}

size_t tl_sun_rays_bytes(const struct tl_sun_rays *rays)
{
    size_t kept = 0;
    for (int i = 0; i < TL_SUNS_MAX; i++)
        kept += rays->visible[i] ? sizeof(float) : 0;
    return rays->capacity * (kept + sizeof(float) + sizeof(uint32_t)) + 2 * rays->texel_capacity;
}
