#include "render/visibility/cover_taps.h"

#include "render/visibility/ray_origins.h"
#include "render/visibility/refresh.h"

#define SAMPLE_BLOCK 1024 /* samples that a thread takes at a time */

static bool is_covered(const uint16_t *covered, uint32_t point)
{
    return covered[point / TL_CLUSTER] >> point % TL_CLUSTER & 1;
}

/* Whether a sample reads points that are covered and points that are not. */
static bool is_mixed(const uint16_t *covered, const struct tl_taps *taps)
{
    int count = 0;
    for (int t = 0; t < 3; t++)
        count += is_covered(covered, taps->point[t]);
    return count == 1 || count == 2;
}

/* Leaves only the points that are (or are not) covered, as the sample is. */
static void keep_alike(const uint16_t *covered, struct tl_taps *taps, bool wanted)
{
    float sum = 0;
    for (int t = 0; t < 3; t++)
        sum += is_covered(covered, taps->point[t]) == wanted ? taps->weight[t] + 1e-6f : 0;
    for (int t = 0; t < 3; t++)
        taps->weight[t] = is_covered(covered, taps->point[t]) == wanted ? (taps->weight[t] + 1e-6f) / sum : 0;
}

/* Tests whether samples are covered, up to a bundle of them, and makes their taps match. */
static void match_some(const struct tl_points_request *request, const uint16_t *covered, struct tl_taps *taps,
                       const uint32_t *samples, int count)
{
    float offset_m = tl_trace_offset(request->trace);
    struct tl_ray_packet up = {.count = count, .to_m = TL_COVER_OFFSETS * offset_m};
    for (int i = 0; i < count; i++) {
        const tl_sample *sample = &request->samples->items[samples[i]];
        vec3s start = tl_sample_start(sample, request->ranges, offset_m);
        up.origin_x[i] = start.x, up.origin_y[i] = start.y, up.origin_z[i] = start.z;
        up.direction_x[i] = sample->smooth.x;
        up.direction_y[i] = sample->smooth.y;
        up.direction_z[i] = sample->smooth.z;
    }
    uint32_t stopped = tl_trace_occluded_packet(request->trace, &up);
    for (int i = 0; i < count; i++)
        keep_alike(covered, &taps[samples[i]], stopped >> i & 1);
}

void tl_taps_match_cover(const struct tl_points_request *request, const uint16_t *covered,
                         struct tl_taps *taps)
{
#pragma omp parallel for schedule(dynamic)
    for (size_t first = 0; first < request->samples->count; first += SAMPLE_BLOCK) {
        size_t end = first + SAMPLE_BLOCK;
        uint32_t mixed[16];
        int count = 0;
        for (size_t i = first; i < end && i < request->samples->count; i++) {
            if (is_mixed(covered, &taps[i]))
                mixed[count++] = (uint32_t)i;
            if (count == 16) {
                match_some(request, covered, taps, mixed, count);
                count = 0;
            }
        }
        if (count > 0)
            match_some(request, covered, taps, mixed, count);
    }
}
