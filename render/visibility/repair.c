#include "render/visibility/repair.h"

#include "config/base/memory.h"
#include "config/base/simd.h"

#include <stdlib.h>
#include <string.h>

#define BLOCK     1024 /* samples that a thread takes at a time */
#define BIN_SHIFT 15   /* a positive float's upper bits, in order: 1/256 of its value */
#define BINS      (1u << 16)

/* The regions' light, in lanes. */
struct weights {
    float x[TL_REGIONS_MAX], y[TL_REGIONS_MAX], z[TL_REGIONS_MAX]; /* world */
    float importance[TL_REGIONS_MAX];
};

static struct weights make_weights(const struct tl_refresh *refresh)
{
    struct weights weights = {0};
    for (int i = 0; i < refresh->request->regions->count; i++) {
        weights.x[i] = refresh->centres[i].x;
        weights.y[i] = refresh->centres[i].y;
        weights.z[i] = refresh->centres[i].z;
        weights.importance[i] = refresh->importances[i];
    }
    return weights;
}

/* The range of the irradiance on a normal among the values of three points. */
TL_INLINE float spread_of(const struct weights *weights, vec3s normal, const uint16_t *const rows[3],
                          size_t stride)
{
    float sums[TL_LANES] = {0};
    for (size_t first = 0; first < stride; first += TL_LANES)
        for (size_t lane = 0; lane < TL_LANES; lane++) {
            size_t i = first + lane;
            uint16_t a = rows[0][i], b = rows[1][i], c = rows[2][i];
            uint16_t high = a > b ? a : b, low = a > b ? b : a;
            high = high > c ? high : c;
            low = low < c ? low : c;
            float cosine = weights->x[i] * normal.x + weights->y[i] * normal.y + weights->z[i] * normal.z;
            sums[lane] += weights->importance[i] * tl_maxf(cosine, 0) * (float)(high - low);
        }
    return tl_sum_lanes(sums);
}

/* The interpolated share of a sample's value: 0 at a corner, largest half-way between corners, and 1 if the
 * sample reads only some of its corners, because the others are covered differently. */
static float share_unknown(const float weights[TL_TAPS], const float corners[3])
{
    float square = 0;
    bool is_changed = false;
    for (int i = 0; i < 3; i++) {
        square += weights[i] * weights[i];
        is_changed |= weights[i] != corners[i];
    }
    return is_changed ? 1 : 1 - square;
}

/* Samples of one triangle are adjacent and share the difference between its corners, computed once. */
TL_CLONES static void measure_block(const struct weights *weights, const struct tl_samples *samples,
                                    const struct tl_taps *taps, const uint16_t *values, size_t stride,
                                    size_t first, size_t end, float *doubts)
{
    uint32_t triangle = UINT32_MAX;
    float spread = 0;
    for (size_t i = first; i < end; i++) {
        const tl_sample *sample = &samples->items[i];
        if (sample->triangle != triangle) {
            const uint16_t *const rows[3] = {values + taps[i].point[0] * stride,
                                             values + taps[i].point[1] * stride,
                                             values + taps[i].point[2] * stride};
            triangle = sample->triangle;
            spread = spread_of(weights, sample->smooth, rows, stride);
        }
        doubts[i] = spread * share_unknown(taps[i].weight, sample->weights);
    }
}

static uint32_t bin_of(float doubt)
{
    uint32_t bits;
    memcpy(&bits, &doubt, sizeof bits);
    return doubt > 0 ? bits >> BIN_SHIFT : 0;
}

/* The bin that the `wanted` largest values reach down to, and how many are taken of it. Bin 0 holds samples
 * without doubt. */
static uint32_t find_limit(const float *doubts, size_t count, size_t wanted, size_t *left)
{
    uint32_t *bins = TL_NEW_ARRAY(uint32_t, BINS), bin = BINS - 1;
    for (size_t i = 0; i < count; i++)
        bins[bin_of(doubts[i])]++;
    *left = wanted;
    while (bin > 0 && bins[bin] <= *left)
        *left -= bins[bin--];
    free(bins);
    return bin;
}

/* `doubts` by sample: how much light its corners disagree about. */
static void collect(struct tl_repair *repair, const float *doubts, size_t sample_count, size_t wanted)
{
    size_t left;
    uint32_t limit = find_limit(doubts, sample_count, wanted, &left);
    if (wanted > repair->capacity) {
        repair->capacity = tl_room_for(wanted, repair->capacity);
        free(repair->samples);
        repair->samples = TL_NEW_ARRAY(uint32_t, repair->capacity);
    }
    repair->count = 0;
    for (size_t i = 0; i < sample_count; i++) {
        uint32_t bin = bin_of(doubts[i]);
        bool last = bin == limit && limit > 0 && left > 0;
        left -= last;
        if (last || bin > limit)
            repair->samples[repair->count++] = (uint32_t)i;
    }
}

void tl_repair_choose(struct tl_repair *repair, const struct tl_refresh *refresh, const struct tl_taps *taps,
                      const uint16_t *values, size_t wanted)
{
    const struct tl_samples *samples = refresh->request->samples;
    struct weights weights = make_weights(refresh);
    repair->rounds = 0;
    repair->next = 0;
    float *doubts = TL_NEW_ARRAY(float, samples->count);
#pragma omp parallel for schedule(dynamic)
    for (size_t first = 0; first < samples->count; first += BLOCK) {
        size_t end = first + BLOCK < samples->count ? first + BLOCK : samples->count;
        measure_block(&weights, samples, taps, values, refresh->stride, first, end, doubts);
    }
    collect(repair, doubts, samples->count, wanted);
    free(doubts);
}

static size_t trace_bundle(const struct tl_repair *repair, const struct tl_refresh *refresh,
                           const struct tl_ray_origins *origins, size_t bundle, uint16_t *values,
                           uint16_t *weights)
{
    vec3s starts[TL_CLUSTER], normals[TL_CLUSTER];
    size_t first = bundle * TL_CLUSTER, row = first * refresh->stride;
    int count = 0;
    for (size_t i = first; i < repair->count && count < TL_CLUSTER; i++, count++) {
        starts[count] = origins->points[repair->samples[i]];
        normals[count] = refresh->request->samples->items[repair->samples[i]].smooth;
    }
    return tl_places_trace(refresh, bundle, repair->rounds, starts, normals, count, values + row,
                           weights + row);
}

size_t tl_repair_trace(struct tl_repair *repair, const struct tl_refresh *refresh,
                       const struct tl_ray_origins *origins, size_t bundles, uint16_t *values,
                       uint16_t *weights)
{
    size_t rays = 0, all = (repair->count + TL_CLUSTER - 1) / TL_CLUSTER, first = repair->next;
    size_t end = bundles < all - first ? first + bundles : all;
    if (repair->rounds == 0 && first == 0)
        memset(weights, 0, repair->count * refresh->stride * sizeof *weights);
#pragma omp parallel for schedule(dynamic, 4) reduction(+ : rays)
    for (size_t bundle = first; bundle < end; bundle++)
        rays += trace_bundle(repair, refresh, origins, bundle, values, weights);
    repair->next = end < all ? end : 0;
    repair->rounds += end == all;
    return rays;
}

void tl_repair_release(struct tl_repair *repair)
{
    free(repair->samples);
    *repair = (struct tl_repair){0};
}

size_t tl_repair_bytes(const struct tl_repair *repair)
{
    return repair->capacity * sizeof(uint32_t);
}

static bool is_covered(const uint16_t *covered, uint32_t point)
{
    return covered[point / TL_CLUSTER] >> point % TL_CLUSTER & 1;
}

/* Returns whether a sample reads both covered and uncovered points. */
static bool is_mixed(const uint16_t *covered, const struct tl_taps *taps)
{
    int count = 0;
    for (int t = 0; t < 3; t++)
        count += is_covered(covered, taps->point[t]);
    return count == 1 || count == 2;
}

/* Keeps only the points that are covered (or not) as the sample is. */
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
    for (size_t first = 0; first < request->samples->count; first += BLOCK) {
        size_t end = first + BLOCK;
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
