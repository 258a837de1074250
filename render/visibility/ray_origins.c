#include "render/visibility/ray_origins.h"

#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

#define BLOCK 1024 /* samples that are hashed in one go, so that the sum does not depend on threads */

static uint64_t mix(uint64_t hash, vec3s point)
{
    for (int i = 0; i < 3; i++) {
        uint32_t bits;
        memcpy(&bits, &point.raw[i], sizeof bits);
        hash = (hash ^ bits) * 0x9e3779b97f4a7c15ull;
        hash ^= hash >> 32;
    }
    return hash;
}

void tl_ray_origins_make(const struct tl_points_request *request, struct tl_ray_origins *out)
{
    size_t count = request->samples->count, block_count = (count + BLOCK - 1) / BLOCK;
    float offset_m = tl_trace_offset(request->trace);
    if (count > out->capacity) {
        out->capacity = tl_room_for(count, out->capacity);
        free(out->points);
        out->points = TL_NEW_ARRAY(vec3s, out->capacity);
    }
    uint64_t *hashes = TL_NEW_ARRAY(uint64_t, block_count);
#pragma omp parallel for schedule(static)
    for (size_t block = 0; block < block_count; block++) {
        size_t end = (block + 1) * BLOCK < count ? (block + 1) * BLOCK : count;
        for (size_t i = block * BLOCK; i < end; i++) {
            const tl_sample *sample = &request->samples->items[i];
            out->points[i] = tl_sample_start(sample, request->ranges, offset_m);
            hashes[block] = mix(hashes[block] + sample->texel, out->points[i]);
        }
    }
    out->samples = count;
    for (size_t block = 0; block < block_count; block++)
        out->samples = (out->samples ^ hashes[block]) * 0x9e3779b97f4a7c15ull;
    free(hashes);
}

void tl_ray_origins_release(struct tl_ray_origins *origins)
{
    free(origins->points);
    *origins = (struct tl_ray_origins){0};
}
