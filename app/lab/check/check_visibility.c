/* Visibility of regions: the range of VIS and of its parts, and VIS compared with rays. */
#include "app/lab/check/check_measures.h"
#include "config/base/memory.h"
#include "render/inside.h"

#include <math.h>
#include <stdlib.h>

/* Points at which VIS is measured, other ones in each frame, and directions of each region. All points use
 * the same directions, because the cache, too, traces one direction for all points that it visits in a frame.
 */
enum { POINTS = 1024, RAYS = 32, BUNDLE = 16 };

/* A region is measured if at least so many points face it, with a cosine of FACES or more. */
enum { MIN_POINTS = POINTS / 4 };
#define FACES 0.2f

/* Allowed sampling error, in standard deviations: a bounded random value is nearly always within three. */
#define DEVIATIONS 3

static bool has_facts(const struct tl_checked *checked, tl_bits facts)
{
    return (tl_frame_facts(checked->frame, checked->settings) & facts) == facts;
}

/* E[z]^2 - E[z^2], relative to E[z^2]; infinite if either is not finite. */
static double moments_deviation(const float *texel)
{
    const double nearest = 1e-2; /* depths near 0 are exact to single precision, their squares are not */
    double mean = (double)texel[0], square = (double)texel[1];
    if (!isfinite(mean) || !isfinite(square))
        return INFINITY;
    double off = (mean * mean - square) / fmax(square, nearest);
    return off > 0 ? off : 0;
}

static double depth_deviation(const float *texel)
{
    double depth = (double)texel[0];
    return !isfinite(depth) ? INFINITY : depth < 0 ? -depth : depth > 1 ? depth - 1 : 0;
}

/* A map is drawn, blurred along rows and along columns. In half precision each rounds both moments by up to
 * 2^-11 of themselves, which the square of the first has twice. */
static double moments_bound(const struct tl_light_params *light)
{
    return light->visibility == TL_VISIBILITY_VSM && light->moments == TL_MOMENTS_HALF ? 9 * 0x1p-11 : 1e-5;
}

void tl_measure_moments(const struct tl_checked *checked, struct tl_finding *finding)
{
    const struct tl_resources *inside = tl_renderer_frame_resources(checked->renderer);
    finding->bound = moments_bound(&checked->settings->light);
    if (!has_facts(checked, TL_BIT(TL_SCENE_MAPS)))
        return;
    for (int i = 0; i < inside->regions.count; i++) {
        struct tl_shadow_texels map = tl_shadow_maps_read(inside->maps, i);
        size_t count = (size_t)map.size * (size_t)map.size, channels = (size_t)map.channels;
        for (size_t t = 0; t < count; t++) {
            const float *texel = map.texels + t * channels;
            if (tl_finding_add(finding, channels == 2 ? moments_deviation(texel) : depth_deviation(texel)))
                tl_finding_place(finding, "map of region %d, texel %zu, %zu", i, t % (size_t)map.size,
                                 t / (size_t)map.size);
        }
        free(map.texels);
    }
}

/* How far interpolation can leave [0, 1]. Stored values lie within it, so that only the weights matter. */
static double taps_deviation(const struct tl_taps *taps, size_t point_count)
{
    double above = 0, below = 0;
    for (int i = 0; i < TL_TAPS; i++) {
        double weight = (double)taps->weight[i];
        if (!isfinite(weight) || taps->point[i] >= point_count)
            return INFINITY;
        above += weight > 0 ? weight : 0;
        below += weight < 0 ? -weight : 0;
    }
    return fmax(fabs(above - 1), below);
}

static double share_deviation(float share)
{
    return !isfinite(share) ? INFINITY : share < 0 ? -(double)share : share > 1 ? (double)share - 1 : 0;
}

static void place_sample(const struct tl_resources *inside, size_t index, struct tl_finding *finding)
{
    const struct tl_samples *samples = &inside->samples;
    uint32_t texel = samples->items[index].texel, width = (uint32_t)samples->width;
    tl_finding_place(finding, "sample %u, %u", texel % width, (uint32_t)samples->height - 1 - texel / width);
}

static bool has_points(const struct tl_checked *checked)
{
    return has_facts(checked, TL_BIT(TL_SCENE_RAYS) | TL_BIT(TL_SCENE_SHADOWS));
}

void tl_measure_visibility(const struct tl_checked *checked, struct tl_finding *finding)
{
    if (!has_points(checked))
        return;
    const struct tl_resources *inside = tl_renderer_frame_resources(checked->renderer);
    const struct tl_taps *taps = tl_points_taps(inside->points);
    size_t points = tl_points_report(inside->points).points;
    for (size_t i = 0; i < inside->samples.count; i++)
        if (tl_finding_add(finding, taps_deviation(&taps[i], points)))
            place_sample(inside, i, finding);
    for (int sun = 0; sun < inside->suns.count; sun++) {
        const float *seen = tl_points_sun(inside->points, sun);
        for (size_t i = 0; seen && i < inside->samples.count; i++)
            if (tl_finding_add(finding, share_deviation(seen[i])))
                place_sample(inside, i, finding);
    }
}

/* Sums over points: the region's VIS, and the visibility along each direction. */
struct tally {
    int points;
    double claimed, seen[RAYS];
};

struct witness {
    const struct tl_resources *inside;
    tl_trace *trace; /* of its own, so that an old one shows too */
    const uint16_t *values;
    const struct tl_taps *taps;
    size_t stride;
    vec3s directions[TL_REGIONS_MAX][RAYS]; /* world */
    struct tally tallies[TL_REGIONS_MAX];
};

/* The sample in place of which a number below POINTS stands in a frame. */
static size_t choose_sample(size_t count, size_t number, int frame)
{
    return (number * count / POINTS + (size_t)frame * 7919) % count;
}

static double claimed_of(const struct witness *witness, size_t sample, int region)
{
    const struct tl_taps *taps = &witness->taps[sample];
    double claimed = 0;
    for (int i = 0; i < TL_TAPS; i++)
        claimed += (double)taps->weight[i] *
                   (double)witness->values[taps->point[i] * witness->stride + (size_t)region] /
                   (double)TL_VISIBILITY_ONE;
    return claimed;
}

/* Directions evenly distributed over the region. */
static vec3s region_direction(const struct tl_resources *inside, int region, int ray)
{
    const float step = 0.5698402909980532f; /* of the plastic number, as tl_region_seen_direction has it */
    float u = ((float)ray + 0.5f) / RAYS, v = (float)ray * step;
    vec3s direction = tl_region_direction(&inside->regions, region, u, v - floorf(v));
    return tl_turn_direction(direction, inside->yaw);
}

/* Whether the whole region is well above the point's horizon. Of other regions, VIS counts only the part
 * above it. */
static bool faces(const struct tl_sample *sample, const vec3s directions[RAYS])
{
    for (int ray = 0; ray < RAYS; ray++)
        if (glms_vec3_dot(directions[ray], sample->smooth) < FACES)
            return false;
    return true;
}

/* Adds the VIS and the traced visibility of one region at one point. */
static void queue_rays(struct witness *witness, const tl_sample *sample, vec3s start, size_t index,
                       int region)
{
    const struct tl_resources *inside = witness->inside;
    const struct tl_ground *ground = tl_ground_drawn(inside);
    const vec3s *directions = witness->directions[region];
    struct tally *tally = &witness->tallies[region];
    if (!faces(sample, directions))
        return;
    tally->points++;
    tally->claimed += claimed_of(witness, index, region);
    for (int first = 0; first < RAYS; first += BUNDLE) {
        struct tl_ray_packet bundle = {.count = BUNDLE, .to_m = INFINITY};
        float seen[BUNDLE];
        for (int i = 0; i < BUNDLE; i++) {
            vec3s direction = directions[first + i];
            bundle.origin_x[i] = start.x, bundle.origin_y[i] = start.y, bundle.origin_z[i] = start.z;
            bundle.direction_x[i] = direction.x, bundle.direction_y[i] = direction.y;
            bundle.direction_z[i] = direction.z;
        }
        tl_trace_transmittance_packet(witness->trace, &bundle, seen);
        for (int i = 0; i < BUNDLE; i++)
            tally->seen[first + i] +=
                (double)(seen[i] * tl_ground_visibility(ground, start, directions[first + i]));
    }
}

static void tally_answers(struct witness *witness, int frame)
{
    const struct tl_resources *inside = witness->inside;
    size_t count = inside->samples.primary_count;
    float offset_m = tl_trace_offset(witness->trace);
    for (int region = 0; region < inside->regions.count; region++)
        for (int ray = 0; ray < RAYS; ray++)
            witness->directions[region][ray] = region_direction(inside, region, ray);
    for (size_t point = 0; point < POINTS && count > 0; point++) {
        size_t index = choose_sample(count, point, frame);
        const tl_sample *sample = &inside->samples.items[index];
        vec3s start = tl_sample_start(sample, &inside->shapes.ranges, offset_m);
        for (int region = 0; region < inside->regions.count; region++)
            queue_rays(witness, sample, start, index, region);
    }
}

/* The region's light relative to the mean region's, at most 1. The cache traces a dark region less often, so
 * that the errors of all regions in the light are equal. */
static double weight_of(const struct tl_regions *regions, int region)
{
    double all = 0;
    for (int i = 0; i < regions->count; i++)
        all += (double)regions->items[i].importance;
    double share = (double)regions->items[region].importance * regions->count;
    return share < all ? share / all : 1;
}

/* Mean and standard deviation of the visibility over the directions. */
static void spread_of(const struct tally *tally, double *mean, double *deviation)
{
    double sum = 0, squares = 0;
    for (int ray = 0; ray < RAYS; ray++) {
        double seen = tally->seen[ray] / tally->points;
        sum += seen;
        squares += seen * seen;
    }
    *mean = sum / RAYS;
    *deviation = sqrt(fmax(squares / RAYS - *mean * *mean, 0));
}

/* The cache traces one direction of the region in a frame, the same for all points or one for each. Its
 * sampling error is therefore at most DEVIATIONS standard deviations over the directions, which are smaller
 * for narrower regions. */
static void add_tallies(const struct witness *witness, struct tl_finding *finding)
{
    const struct tl_regions *regions = &witness->inside->regions;
    for (int i = 0; i < regions->count; i++) {
        const struct tally *tally = &witness->tallies[i];
        double mean, deviation;
        if (tally->points < MIN_POINTS)
            continue;
        spread_of(tally, &mean, &deviation);
        double claimed = tally->claimed / tally->points, off = fabs(claimed - mean) - DEVIATIONS * deviation;
        if (tl_finding_add(finding, weight_of(regions, i) * (off < 0 ? 0 : off)))
            tl_finding_place(finding, "region %d: VIS %.2f, rays %.2f, deviating by %.2f, of %d points", i,
                             claimed, mean, deviation, tally->points);
    }
}

void tl_measure_leaks(const struct tl_checked *checked, struct tl_finding *finding)
{
    tl_error error = {0};
    if (!checked->is_sampled || !has_points(checked))
        return;
    struct witness *witness = TL_NEW(struct witness);
    witness->inside = tl_renderer_frame_resources(checked->renderer);
    witness->trace = tl_trace_create(&error);
    witness->values =
        tl_points_values(tl_renderer_frame_resources(checked->renderer)->points, &witness->stride);
    witness->taps = tl_points_taps(tl_renderer_frame_resources(checked->renderer)->points);
    if (witness->trace &&
        tl_trace_update(witness->trace, checked->frame->surfaces, checked->frame->surface_count, &error)) {
        tally_answers(witness, checked->number);
        add_tallies(witness, finding);
    } else {
        tl_finding_add(finding, NAN);
        tl_finding_place(finding, "%s", error.message);
    }
    tl_trace_destroy(&witness->trace);
    free(witness);
}

/* The light on a sample from regions that face it, and how much of it has a VIS older than `allowed` frames.
 */
static void add_light_by_age(const struct tl_resources *inside, size_t index, double allowed, double *late,
                             double *all)
{
    const struct tl_taps *taps = &tl_points_taps(inside->points)[index];
    const tl_sample *sample = &inside->samples.items[index];
    for (int r = 0; r < inside->regions.count; r++) {
        const struct tl_region *region = &inside->regions.items[r];
        float cosine = glms_vec3_dot(tl_turn_direction(region->direction, inside->yaw), sample->smooth);
        double light = (double)(region->importance * fmaxf(cosine, 0));
        uint32_t oldest = 0;
        for (int i = 0; i < TL_TAPS; i++) {
            uint32_t age = taps->weight[i] > 0 ? tl_points_age(inside->points, taps->point[i], r) : 0;
            oldest = age > oldest ? age : oldest;
        }
        *all += light;
        *late += (double)oldest > allowed ? light : 0;
    }
}

void tl_measure_age(const struct tl_checked *checked, struct tl_finding *finding)
{
    const double rounds = 4; /* render/visibility/refresh.c: then a region goes before others */
    int renewed = checked->settings->light.refresh;
    if (!has_points(checked) || renewed == 0)
        return;
    const struct tl_resources *inside = tl_renderer_frame_resources(checked->renderer);
    size_t count = inside->samples.primary_count;
    double late = 0, all = 0, allowed = rounds * ceil((double)inside->regions.count / renewed);
    for (size_t point = 0; point < POINTS && count > 0; point++)
        add_light_by_age(inside, choose_sample(count, point, checked->number), allowed, &late, &all);
    if (!(all > 0))
        return;
    tl_finding_add(finding, late / all);
    tl_finding_place(finding, "of %d points: older than %.0f frames", POINTS, allowed);
}
