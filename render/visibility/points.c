#include "render/visibility/points.h"

#include "config/base/memory.h"
#include "config/base/simd.h"
#include "render/visibility/cache_probes.h"
#include "render/visibility/maps.h"
#include "render/visibility/ray_origins.h"
#include "render/visibility/repair.h"
#include "render/visibility/sun_rays.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A point that was out of sight for so many moving frames is as good as new. */
#define FORGET_FRAMES 8

enum { NO_SLOT = UINT32_MAX };

struct tl_points {
    uint64_t regions_revision, shapes_revision;
    bool known;   /* the revisions are of something */
    bool carried; /* in this update: values are not where they were in the last one */
    float yaw;
    struct tl_regions regions; /* directions only: those that the values belong to */
    uint32_t frame;            /* counts updates, from 1 */
    uint32_t motion;           /* counts moving frames, from 2 */
    uint32_t rest;             /* the last frame in which nothing moved; 0: none */

    struct tl_cache_probes probes;
    uint32_t *seen;   /* [probes]: frame when last visible */
    uint32_t since;   /* those count as visible that were so since this frame */
    uint32_t *slots;  /* [clusters]: where its values are; NO_SLOT: nowhere yet */
    uint32_t *active; /* [active_count]: clusters with visible probes */
    size_t active_count, visible_count;

    size_t slot_count, slot_capacity, stride;
    uint16_t *values;  /* [slots][TL_CLUSTER][stride] */
    uint16_t *weights; /* ... : of the directions in each mean at rest */
    uint16_t *rounds;  /* [slots][stride]: frames at rest in which a region was traced */
    uint32_t *rested;  /* [slots]: `motion` when the weights and rounds were begun */
    uint32_t *traced;  /* [slots][TL_CLUSTER]: `motion` when a point was last traced; 0: never */
    uint16_t *covered; /* [slots]: bit i: something lies close above point i */
    uint32_t *stamps;  /* [slots][stride]: frame when a region was last traced */

    struct tl_taps *taps;
    size_t sample_count, sample_capacity;
    bool are_for_samples; /* the last update; with no sample covered, too */
    bool is_sparse;       /* the last update */
    size_t ray_count;
    /* At rest: of the points of the slots, each region has been looked at; has had its rounds; and all else.
     */
    bool have_begun, are_done, is_done;

    struct tl_ray_origins origins; /* made when suns or repair need them */
    struct tl_sun_rays suns;
    struct tl_repair repair; /* its points come after those of the slots */
};

tl_points *tl_points_create(void)
{
    tl_points *points = TL_NEW(tl_points);
    points->motion = 1; /* what was traced in no motion is from before */
    return points;
}

static void forget_values(tl_points *points)
{
    free(points->values);
    free(points->weights);
    free(points->rounds);
    free(points->rested);
    free(points->traced);
    free(points->covered);
    free(points->stamps);
    points->values = points->weights = points->rounds = points->covered = NULL;
    points->rested = points->traced = points->stamps = NULL;
    points->slot_count = points->slot_capacity = 0;
    for (size_t i = 0; i < points->probes.cluster_count; i++)
        points->slots[i] = NO_SLOT;
}

static void forget_probes(tl_points *points)
{
    forget_values(points);
    tl_cache_probes_release(&points->probes);
    free(points->seen);
    free(points->slots);
    free(points->active);
}

void tl_points_destroy(tl_points **points)
{
    if (!*points)
        return;
    forget_probes(*points);
    free((*points)->taps);
    tl_ray_origins_release(&(*points)->origins);
    tl_sun_rays_release(&(*points)->suns);
    tl_repair_release(&(*points)->repair);
    free(*points);
    *points = NULL;
}

static void build_probes(tl_points *points, const struct tl_points_request *request)
{
    forget_probes(points);
    tl_cache_probes_build(request->ranges, &points->probes);
    size_t count = points->probes.cluster_count;
    points->seen = TL_NEW_ARRAY(uint32_t, count * TL_CLUSTER);
    points->slots = TL_NEW_ARRAY(uint32_t, count);
    points->active = TL_NEW_ARRAY(uint32_t, count);
    for (size_t i = 0; i < count; i++)
        points->slots[i] = NO_SLOT;
}

static size_t stride_of(int region_count)
{
    return ((size_t)region_count + TL_LANES - 1) / TL_LANES * TL_LANES;
}

/* source[i]: the old region that is nearest to region i, in the world. */
static void find_sources(const tl_points *points, const struct tl_points_request *request,
                         int source[TL_REGIONS_MAX])
{
    float turn = request->environment_yaw - points->yaw;
#pragma omp parallel for
    for (int i = 0; i < request->regions->count; i++) {
        vec3s direction = tl_turn_direction(request->regions->items[i].direction, turn);
        float best = -2;
        source[i] = 0;
        for (int k = 0; k < points->regions.count; k++) {
            float cosine = glms_vec3_dot(direction, points->regions.items[k].direction);
            if (cosine > best) {
                best = cosine;
                source[i] = k;
            }
        }
    }
}

/* Values move to the regions that are now where theirs were, and count as old: the most important ones are
 * traced first. */
static void carry_over(tl_points *points, const struct tl_points_request *request)
{
    int source[TL_REGIONS_MAX], count = request->regions->count;
    size_t stride = stride_of(count);
    find_sources(points, request, source);
    uint16_t *values = TL_NEW_ARRAY(uint16_t, points->slot_capacity * TL_CLUSTER * stride);
    uint32_t *stamps = TL_NEW_ARRAY(uint32_t, points->slot_capacity * stride);
    uint16_t *weights = TL_NEW_ARRAY(uint16_t, points->slot_capacity * TL_CLUSTER * stride);
    uint16_t *rounds = TL_NEW_ARRAY(uint16_t, points->slot_capacity * stride);
#pragma omp parallel for
    for (size_t p = 0; p < points->slot_count * TL_CLUSTER; p++)
        for (int i = 0; i < count; i++)
            values[p * stride + (size_t)i] = points->values[p * points->stride + (size_t)source[i]];
    free(points->values);
    free(points->weights);
    free(points->rounds);
    free(points->stamps);
    points->values = values;
    points->weights = weights;
    points->rounds = rounds;
    points->stamps = stamps;
    points->stride = stride;
}

static bool is_where_it_was(const int source[TL_REGIONS_MAX], int count)
{
    for (int i = 0; i < count; i++)
        if (source[i] != i)
            return false;
    return true;
}

/* A small turn leaves the values with their regions: they are traced again before the error grows. */
static bool has_turned_far(const tl_points *points, const struct tl_points_request *request)
{
    int source[TL_REGIONS_MAX];
    if (request->environment_yaw == points->yaw) // NOLINT
        return false;
    find_sources(points, request, source);
    return !is_where_it_was(source, request->regions->count);
}

static void follow_changes(tl_points *points, const struct tl_points_request *request)
{
    points->carried = false;
    if (!points->known || points->shapes_revision != request->shapes_revision) {
        build_probes(points, request);
        points->stride = stride_of(request->regions->count);
        points->carried = true;
    } else if (points->regions_revision != request->regions_revision || has_turned_far(points, request)) {
        carry_over(points, request);
        points->carried = true;
    }
    points->known = true;
    points->shapes_revision = request->shapes_revision;
    points->regions_revision = request->regions_revision;
    points->yaw = request->environment_yaw;
    points->regions.count = request->regions->count;
    memcpy(points->regions.items, request->regions->items,
           (size_t)request->regions->count * sizeof *request->regions->items);
    points->frame++;
    points->motion += request->moved;
    points->is_sparse = request->moved && !request->samples && !request->whole_rounds;
    /* Images at rest that are shifted by parts of a pixel see a few triangles more or less: what one of them
     * sees has its rounds in all. */
    if (request->samples || request->moved || request->only_camera || points->carried)
        points->since = points->frame;
}

static void mark_sample(tl_points *points, const struct tl_points_request *request, size_t index)
{
    const tl_sample *sample = &request->samples->items[index];
    struct tl_taps *taps = &points->taps[index];
    uint32_t corners[3];
    size_t surface;
    tl_triangle_find(request->ranges, sample->triangle & ~TL_SAMPLE_BACK, corners, &surface);
    bool back = sample->triangle & TL_SAMPLE_BACK;
    *taps = (struct tl_taps){0};
    for (int i = 0; i < 3; i++) {
        taps->point[i] = tl_cache_probe_at(&points->probes, surface, corners[i], back);
        taps->weight[i] = sample->weights[i];
        /* Threads may mark one probe at once: they write the same. */
        __atomic_store_n(&points->seen[taps->point[i]], points->frame, __ATOMIC_RELAXED);
    }
}

/* The corners of the triangles, or the vertices from which these take their light. */
static void mark_triangles(tl_points *points, const struct tl_points_request *request)
{
    points->sample_count = 0;
    for (size_t i = 0; i < request->seen_count; i++) {
        uint32_t corners[3];
        size_t surface;
        const tl_surface *shape =
            tl_triangle_find(request->ranges, request->seen[i] & ~TL_SAMPLE_BACK, corners, &surface);
        for (int k = 0; k < 3; k++) {
            const uint32_t *from = points->is_sparse ? tl_light_from(shape, &corners[k]) : &corners[k];
            for (int j = 0; j < (from == &corners[k] ? 1 : 3); j++)
                points->seen[tl_cache_probe_at(&points->probes, surface, from[j],
                                               request->seen[i] & TL_SAMPLE_BACK)] = points->frame;
        }
    }
}

static void mark_samples(tl_points *points, const struct tl_points_request *request)
{
    points->sample_count = request->samples->count;
    if (points->sample_count > points->sample_capacity) {
        points->sample_capacity = tl_room_for(points->sample_count, points->sample_capacity);
        free(points->taps);
        points->taps = TL_NEW_ARRAY(struct tl_taps, points->sample_capacity);
    }
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < points->sample_count; i++)
        mark_sample(points, request, i);
}

/* An array of `used` items grows to `count`; what is added is 0. */
static void *grow(void *items, size_t used, size_t count, size_t size)
{
    char *grown = tl_resize(items, count, size);
    memset(grown + used * size, 0, (count - used) * size);
    return grown;
}

static void reserve_slots(tl_points *points, size_t count)
{
    if (count <= points->slot_capacity)
        return;
    size_t used = points->slot_count, capacity = tl_room_for(count, points->slot_capacity);
    size_t stride = points->stride;
    size_t row = TL_CLUSTER * stride;
    points->slot_capacity = capacity;
    points->values = grow(points->values, used * row, capacity * row, sizeof(uint16_t));
    points->weights = grow(points->weights, used * row, capacity * row, sizeof(uint16_t));
    points->rounds = grow(points->rounds, used * stride, capacity * stride, sizeof(uint16_t));
    points->rested = grow(points->rested, used, capacity, sizeof(uint32_t));
    points->traced = grow(points->traced, used * TL_CLUSTER, capacity * TL_CLUSTER, sizeof(uint32_t));
    points->covered = grow(points->covered, used, capacity, sizeof(uint16_t));
    points->stamps = grow(points->stamps, used * stride, capacity * stride, sizeof(uint32_t));
}

static uint32_t visible_members(const tl_points *points, size_t cluster)
{
    uint32_t members = 0;
    for (size_t i = 0; i < TL_CLUSTER; i++)
        members |= (uint32_t)(points->seen[cluster * TL_CLUSTER + i] >= points->since) << i;
    return members;
}

/* Lists the clusters in sight and gives each a slot. */
static void activate_clusters(tl_points *points, size_t repair_count)
{
    size_t slot_count = points->slot_count;
    points->active_count = points->visible_count = 0;
    for (size_t c = 0; c < points->probes.cluster_count; c++) {
        uint32_t members = visible_members(points, c);
        if (!members)
            continue;
        points->active[points->active_count++] = (uint32_t)c;
        points->visible_count += (size_t)__builtin_popcount(members);
        if (points->slots[c] == NO_SLOT)
            points->slots[c] = (uint32_t)slot_count++;
    }
    reserve_slots(points, slot_count + (repair_count + TL_CLUSTER - 1) / TL_CLUSTER);
    points->slot_count = slot_count;
}

/* Assigns points to the visible probes. */
static void resolve_taps(tl_points *points)
{
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < points->sample_count; i++)
        for (int t = 0; t < TL_TAPS; t++) {
            uint32_t probe = points->taps[i].point[t];
            points->taps[i].point[t] = points->slots[probe / TL_CLUSTER] * TL_CLUSTER + probe % TL_CLUSTER;
        }
}

/* In motion all points share the directions: one a region differs visibly from another. They are the same in
 * all frames: other ones in each err no less, and flicker where nothing moves. One ray a region takes the
 * region's own direction. */
vec3s *tl_points_directions(const struct tl_regions *regions, int rays, float environment_yaw)
{
    int count = regions->count;
    vec3s *directions = TL_NEW_ARRAY(vec3s, (size_t)count * (size_t)rays);
#pragma omp parallel for
    for (int i = 0; i < count; i++)
        for (int k = 0; k < rays; k++) {
            const struct tl_region *region = &regions->items[i];
            vec3s direction = rays == 1 ? region->direction : tl_region_sample(regions, i, (uint32_t)k);
            directions[i * rays + k] = tl_turn_direction(direction, environment_yaw);
        }
    return directions;
}

/* The means are reset when something has moved since the last rest. A point that comes into sight
 * has its cluster's rounds begun again: the others' means only grow. */
static void begin_rest(tl_points *points, size_t slot, uint32_t members)
{
    uint16_t *rounds = points->rounds + slot * points->stride;
    bool joined = false;
    if (points->rested[slot] != points->motion) {
        points->rested[slot] = points->motion;
        memset(points->weights + slot * TL_CLUSTER * points->stride, 0,
               TL_CLUSTER * points->stride * sizeof(uint16_t));
        joined = true;
    }
    for (size_t i = 0; i < TL_CLUSTER; i++)
        joined |= members >> i & 1 && points->traced[slot * TL_CLUSTER + i] != points->motion;
    if (joined)
        memset(rounds, 0, points->stride * sizeof *rounds);
}

/* Notes that a point is traced in this frame; true when it holds nothing of use. */
static bool begin_point(tl_points *points, size_t point)
{
    bool fresh = points->traced[point] == 0 || points->motion - points->traced[point] > FORGET_FRAMES;
    points->traced[point] = points->motion;
    return fresh;
}

static struct tl_cluster open_cluster(tl_points *points, size_t number, const struct tl_refresh *refresh)
{
    size_t slot = points->slots[number], first = slot * TL_CLUSTER;
    struct tl_cluster cluster = {.number = number,
                                 .probes = points->probes.items + number * TL_CLUSTER,
                                 .members = visible_members(points, number),
                                 .values = points->values + first * points->stride,
                                 .weights = points->weights + first * points->stride,
                                 .rounds = points->rounds + slot * points->stride,
                                 .covered = points->covered + slot,
                                 .stamps = points->stamps + slot * points->stride};
    if (refresh->whole_rounds || !refresh->request->moved)
        begin_rest(points, slot, cluster.members);
    for (size_t i = 0; i < TL_CLUSTER; i++)
        if (cluster.members >> i & 1)
            cluster.fresh |= (uint32_t)begin_point(points, first + i) << i;
    return cluster;
}

/* Whether a point was traced in the last frame that moved. */
static bool is_traced(const tl_points *points, uint32_t point)
{
    return points->traced[point] == points->motion;
}

/* A vertex that took its light from others while the surface moved begins to rest with the mean of what they
 * see. Without it all regions of all such vertices were due in the first frame at rest. */
static void begin_with_mean(tl_points *points, const struct tl_points_request *request, size_t number)
{
    const struct tl_cache_probe *probe = &points->probes.items[number];
    const tl_surface *surface = request->ranges->surfaces[probe->surface];
    const uint32_t point = tl_points_of_vertex(points, probe->surface, probe->vertex, probe->back);
    const uint32_t *from = surface->light_mesh->from[probe->vertex];
    uint32_t sources[3];
    for (int k = 0; k < 3; k++) {
        const uint32_t source = tl_cache_probe_at(&points->probes, probe->surface, from[k], probe->back);
        if (points->slots[source / TL_CLUSTER] == NO_SLOT)
            return;
        sources[k] = points->slots[source / TL_CLUSTER] * TL_CLUSTER + source % TL_CLUSTER;
        if (!is_traced(points, sources[k]))
            return;
    }
    for (size_t i = 0; i < points->stride; i++) {
        float mean = 0.5f;
        for (int k = 0; k < 3; k++)
            mean += surface->light_mesh->shares[probe->vertex][k] *
                    (float)points->values[sources[k] * points->stride + i];
        points->values[point * points->stride + i] = (uint16_t)fminf(fmaxf(mean, 0), UINT16_MAX);
    }
    points->traced[point] = points->motion - 1;
}

static void begin_with_means(tl_points *points, const struct tl_points_request *request)
{
    for (size_t i = 0; !request->moved && i < points->active_count; i++) {
        const size_t first = points->active[i] * (size_t)TL_CLUSTER;
        const uint32_t members = visible_members(points, points->active[i]);
        const struct tl_cache_probe *probe = &points->probes.items[first];
        if (tl_has_own_light(request->ranges->surfaces[probe->surface], probe->vertex))
            continue;
        for (size_t k = 0; k < TL_CLUSTER; k++)
            if (members >> k & 1 &&
                !is_traced(points, points->slots[points->active[i]] * TL_CLUSTER + (uint32_t)k))
                begin_with_mean(points, request, first + k);
    }
}

static void trace_clusters(tl_points *points, const struct tl_refresh *refresh)
{
    bool moved = refresh->request->moved;
    size_t begun = 0, done = 0, rays = 0;
#pragma omp parallel for schedule(dynamic, 4) reduction(+ : begun, done, rays)
    for (size_t i = 0; i < points->active_count; i++) {
        struct tl_cluster cluster = open_cluster(points, points->active[i], refresh);
        int rounds = refresh->request->params->rounds;
        if (moved || tl_cluster_rounds(refresh, &cluster) < rounds)
            rays += tl_cluster_refresh(refresh, &cluster);
        begun += !moved && tl_cluster_rounds(refresh, &cluster) > 0;
        done += !moved && tl_cluster_rounds(refresh, &cluster) >= rounds;
    }
    points->ray_count = rays;
    points->have_begun = begun == points->active_count;
    points->are_done = done == points->active_count;
}

static size_t share_of(float share, const struct tl_points_request *request)
{
    return request->samples ? (size_t)(share * (float)request->samples->count) : 0;
}

/* Samples with points of their own: in motion, and once nothing moves. */
static size_t repaired_in_motion(const struct tl_points_request *request)
{
    return share_of(request->params->repair, request);
}

static size_t repaired_at_rest(const struct tl_points_request *request)
{
    return share_of(fmaxf(request->params->repair, request->params->repair_rest), request);
}

/* The samples that this update, and those after it that make one still image, may give points of their own.
 */
static size_t repaired_now(const struct tl_points_request *request)
{
    return request->moved && !request->whole_rounds ? repaired_in_motion(request) : repaired_at_rest(request);
}

/* So many bundles of samples take as many rays as the points do in a frame. */
static size_t bundles_of_a_frame(const tl_points *points, const struct tl_refresh *refresh)
{
    const struct tl_points_request *request = refresh->request;
    if (refresh->whole_rounds || request->moved)
        return SIZE_MAX;
    size_t rays = TL_REST_RAY_FACTOR * points->visible_count * (size_t)request->params->refresh;
    return rays / ((size_t)request->regions->count * TL_CLUSTER) + 1;
}

/* The samples to repair are chosen once for an image in motion and once at rest, when the points' values are
 * good enough to find them. */
static void choose_samples(tl_points *points, const struct tl_refresh *refresh, bool again)
{
    struct tl_repair *repair = &points->repair;
    size_t in_motion = repaired_in_motion(refresh->request), at_rest = repaired_at_rest(refresh->request);
    if (!again && in_motion == 0)
        repair->count = 0;
    else if (!again)
        tl_repair_choose(repair, refresh, points->taps, points->values, in_motion);
    else if (at_rest > in_motion && !repair->at_rest && points->have_begun)
        tl_repair_choose(repair, refresh, points->taps, points->values, at_rest);
    repair->at_rest = again && (repair->at_rest || points->have_begun);
}

/* Gives the samples that need it points of their own, after those of the slots. They are read once every
 * region has been looked at. */
static void repair_samples(tl_points *points, const struct tl_refresh *refresh)
{
    struct tl_repair *repair = &points->repair;
    size_t first = points->slot_count * TL_CLUSTER, row = first * points->stride;
    if (repair->count > 0 && repair->rounds < refresh->request->params->rounds)
        points->ray_count +=
            tl_repair_trace(repair, refresh, &points->origins, bundles_of_a_frame(points, refresh),
                            points->values + row, points->weights + row);
}

static void read_repaired(tl_points *points)
{
    const struct tl_repair *repair = &points->repair;
    size_t first = points->slot_count * TL_CLUSTER;
    for (size_t i = 0; repair->rounds > 0 && i < repair->count; i++) {
        uint32_t point = (uint32_t)(first + i);
        points->taps[repair->samples[i]] = (struct tl_taps){.point = {point, point, point}, .weight = {1}};
    }
}

/* Makes the origins of the samples' rays; true when nothing has changed since they were made. */
static bool follow_samples(tl_points *points, const struct tl_points_request *request)
{
    bool has_suns = request->samples && request->suns && request->suns->count > 0;
    size_t repaired = repaired_now(request);
    uint64_t before = points->origins.samples;
    points->origins.samples = 0;
    if (!has_suns && repaired == 0)
        return false;
    tl_ray_origins_make(request, &points->origins);
    return !request->moved && !points->carried && points->origins.samples == before;
}

static void trace_suns(tl_points *points, const struct tl_points_request *request, bool again)
{
    if (request->samples && request->suns && request->suns->count > 0)
        points->ray_count += tl_sun_rays_update(&points->suns, request, &points->origins, again);
    else
        points->suns.count = 0;
}

/* A frame at rest is to cost no more than one in motion: points and samples of their own take turns. Points
 * go first until each region has been looked at, then the samples' first round, then points to their end. */
static void trace_in_turn(tl_points *points, const struct tl_refresh *refresh)
{
    bool again = follow_samples(points, refresh->request);
    const struct tl_repair *repair = &points->repair;
    bool samples_first = again && repair->at_rest && repair->count > 0 && repair->rounds == 0;
    points->ray_count = 0;
    if (refresh->whole_rounds || !samples_first)
        trace_clusters(points, refresh);
    if (refresh->request->samples)
        tl_taps_match_cover(refresh->request, points->covered, points->taps);
    trace_suns(points, refresh->request, again);
    choose_samples(points, refresh, again);
    if (refresh->whole_rounds || !again || samples_first || points->are_done)
        repair_samples(points, refresh);
    read_repaired(points);
}

static bool is_all_done(const tl_points *points, const struct tl_points_request *request)
{
    int rounds = request->params->rounds;
    const struct tl_repair *repair = &points->repair;
    bool repaired = repair->at_rest && (repair->count == 0 || repair->rounds >= rounds);
    return points->are_done && (points->suns.count == 0 || points->suns.rounds >= rounds) &&
           (repaired || repaired_at_rest(request) == 0);
}

static bool takes_whole_rounds(const struct tl_points_request *request)
{
    int wanted = request->params->refresh;
    return request->whole_rounds || wanted == 0 || wanted >= request->regions->count;
}

static void trace_all(tl_points *points, const struct tl_points_request *request)
{
    const bool is_shared = request->moved && !request->whole_rounds;
    vec3s centres[TL_REGIONS_MAX], *directions = NULL;
    if (is_shared)
        directions = tl_points_directions(request->regions, request->params->rays, request->environment_yaw);
    float importances[TL_REGIONS_MAX];
    for (int i = 0; i < request->regions->count; i++) {
        const struct tl_region *region = &request->regions->items[i];
        centres[i] = tl_turn_direction(region->direction, request->environment_yaw);
        importances[i] = request->params->weighs_solid_angle ? region->solid_angle : region->importance;
    }
    const struct tl_refresh refresh = {.request = request,
                                       .stride = points->stride,
                                       .directions = directions,
                                       .centres = centres,
                                       .importances = importances,
                                       .offset_m = tl_trace_offset(request->trace),
                                       .frame = points->frame,
                                       .whole_rounds = takes_whole_rounds(request)};
    trace_in_turn(points, &refresh);
    points->is_done = is_all_done(points, request);
    free(directions);
}

void tl_points_update(tl_points *points, const struct tl_points_request *request)
{
    assert(request->regions->count > 0 && request->params->rays > 0);
    follow_changes(points, request);
    points->rest = request->moved ? points->rest : points->frame;
    points->are_for_samples = request->samples != NULL;
    if (request->samples)
        mark_samples(points, request);
    else
        mark_triangles(points, request);
    activate_clusters(points, repaired_now(request));
    resolve_taps(points);
    begin_with_means(points, request);
    trace_all(points, request);
}

const uint16_t *tl_points_values(const tl_points *points, size_t *stride)
{
    *stride = points->stride;
    return points->values;
}

uint32_t tl_points_age(const tl_points *points, uint32_t point, int region)
{
    size_t slot = point / TL_CLUSTER;
    if (slot >= points->slot_count)
        return 0;
    uint32_t traced = points->stamps[slot * points->stride + (size_t)region];
    return points->frame - (traced > points->rest ? traced : points->rest);
}

const struct tl_taps *tl_points_taps(const tl_points *points)
{
    return points->are_for_samples ? points->taps : NULL;
}

bool tl_points_are_for_samples(const tl_points *points)
{
    return points->are_for_samples;
}

bool tl_points_are_sparse(const tl_points *points)
{
    return points->is_sparse;
}

uint32_t tl_points_of_vertex(const tl_points *points, size_t surface, uint32_t vertex, bool back)
{
    uint32_t probe = tl_cache_probe_at(&points->probes, surface, vertex, back);
    return points->slots[probe / TL_CLUSTER] * TL_CLUSTER + probe % TL_CLUSTER;
}

float tl_points_cover_m(const tl_trace *trace)
{
    return TL_COVER_OFFSETS * tl_trace_offset(trace);
}

bool tl_points_is_covered(const tl_points *points, uint32_t point)
{
    return points->covered[point / TL_CLUSTER] >> point % TL_CLUSTER & 1;
}

bool tl_points_are_done(const tl_points *points)
{
    return points->is_done;
}

const float *tl_points_sun(const tl_points *points, int sun)
{
    return sun < points->suns.count ? points->suns.visible[sun] : NULL;
}

/* The largest difference between the points that a sample reads, over the regions. */
static float disagreement(const tl_points *points, const struct tl_taps *taps)
{
    int largest = 0;
    for (size_t i = 0; i < points->stride; i++) {
        int low = UINT16_MAX, high = 0;
        for (int t = 0; t < TL_TAPS; t++) {
            int value = points->values[taps->point[t] * points->stride + i];
            low = value < low ? value : low;
            high = value > high ? value : high;
        }
        largest = high - low > largest ? high - low : largest;
    }
    return (float)largest / TL_VISIBILITY_ONE;
}

struct tl_points_report tl_points_report(const tl_points *points)
{
    struct tl_points_report report = {.points = points->slot_count * TL_CLUSTER + points->repair.count,
                                      .visible_points = points->visible_count,
                                      .repaired_samples = points->repair.count,
                                      .rays = points->ray_count};
    for (size_t i = 0; i < points->sample_count; i++)
        report.disagreement += (double)disagreement(points, &points->taps[i]) / (double)points->sample_count;
    return report;
}

size_t tl_points_visible(const tl_points *points)
{
    return points->visible_count;
}

size_t tl_points_bytes(const tl_points *points)
{
    size_t probes = points->probes.cluster_count * TL_CLUSTER, slots = points->slot_capacity;
    size_t vertices = points->probes.cluster_count > 0 ? probes : 0;
    return probes * (sizeof(struct tl_cache_probe) + sizeof(uint32_t)) + vertices * sizeof(uint32_t) +
           points->probes.cluster_count * 2 * sizeof(uint32_t) +
           slots * (sizeof(uint16_t) + sizeof(uint32_t)) +
           slots * TL_CLUSTER * (points->stride * 2 * sizeof(uint16_t) + sizeof(uint32_t)) +
           slots * points->stride * (sizeof(uint16_t) + sizeof(uint32_t)) +
           points->sample_capacity * sizeof(struct tl_taps) + points->origins.capacity * sizeof(vec3s) +
           tl_sun_rays_bytes(&points->suns) + tl_repair_bytes(&points->repair);
}
