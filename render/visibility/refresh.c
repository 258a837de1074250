#include "render/visibility/refresh.h"

#include "config/base/simd.h"
#include "render/env/cube.h"

#include <math.h>
#include <string.h>

/* A region that has not been traced for LATE_ROUNDS average rounds is late. At most one in LATE_SHARE of the
 * regions traced in a frame is chosen because it is late, or important ones would wait for all late ones. */
#define LATE_ROUNDS 4
#define LATE_SHARE  4

/* At rest clusters take turns with so many runs of directions, which follow one another in each region's
 * sequence, a round after the other however many frames lie between. If all points looked in the same
 * directions, what these miss of a region would be missing everywhere: after 16 rounds 0.1 to 0.3 % of the
 * image's mean. So neighbouring clusters err each by themselves. */
#define DIRECTION_RUNS 16

/* The members of a cluster, one a lane. */
struct cluster_lanes {
    uint32_t members;
    float x[TL_CLUSTER], y[TL_CLUSTER], z[TL_CLUSTER];    /* where rays start, world */
    float nx[TL_CLUSTER], ny[TL_CLUSTER], nz[TL_CLUSTER]; /* on the point's side, unit */
};

static vec3s lane_normal(const struct cluster_lanes *lanes, int i)
{
    return (vec3s){{lanes->nx[i], lanes->ny[i], lanes->nz[i]}};
}

static vec3s lane_origin(const struct cluster_lanes *lanes, int i)
{
    return (vec3s){{lanes->x[i], lanes->y[i], lanes->z[i]}};
}

static void set_lane(struct cluster_lanes *lanes, int i, vec3s origin, vec3s normal)
{
    lanes->x[i] = origin.x, lanes->y[i] = origin.y, lanes->z[i] = origin.z;
    lanes->nx[i] = normal.x, lanes->ny[i] = normal.y, lanes->nz[i] = normal.z;
}

/* Adds member i's ray to a bundle. */
static void push_ray(struct tl_ray_packet *bundle, const struct cluster_lanes *lanes, int i, vec3s direction)
{
    int k = bundle->count++;
    bundle->origin_x[k] = lanes->x[i];
    bundle->origin_y[k] = lanes->y[i];
    bundle->origin_z[k] = lanes->z[i];
    bundle->direction_x[k] = direction.x;
    bundle->direction_y[k] = direction.y;
    bundle->direction_z[k] = direction.z;
}

/* Moves a point out of a body that it lies slightly inside, such as a waistband in a hip: rays in both
 * directions of the normal then hit the back of the same other surface. (A body under a dress hits the
 * dress's back in one direction only, and a pleat hits its own surface.) */
static bool lift(const struct tl_refresh *refresh, const struct tl_cache_probe *probe,
                 struct cluster_lanes *lanes, int i)
{
    const tl_trace *trace = refresh->request->trace;
    vec3s origin = lane_origin(lanes, i), normal = lane_normal(lanes, i);
    struct tl_trace_hit out =
        tl_trace_nearest(trace, origin, normal, 0, TL_COVER_OFFSETS * refresh->offset_m);
    if (out.surface == TL_TRACE_NONE || !out.back || out.surface == probe->surface)
        return false;
    vec3s below = glms_vec3_sub(origin, glms_vec3_scale(normal, 2 * refresh->offset_m));
    struct tl_trace_hit in = tl_trace_nearest(trace, below, glms_vec3_negate(normal), 0, INFINITY);
    if (in.surface != out.surface || !in.back)
        return false;
    origin = glms_vec3_add(origin, glms_vec3_scale(normal, out.distance_m + refresh->offset_m));
    set_lane(lanes, i, origin, normal);
    return true;
}

static void place_members(const struct tl_refresh *refresh, const struct tl_cluster *cluster,
                          struct cluster_lanes *lanes)
{
    *lanes = (struct cluster_lanes){.members = cluster->members};
    struct tl_ray_packet up = {.to_m = TL_COVER_OFFSETS * refresh->offset_m, .coherent = true};
    int lane_of[TL_CLUSTER];
    for (int i = 0; i < TL_CLUSTER; i++) {
        if (!(lanes->members >> i & 1))
            continue;
        const struct tl_cache_probe *probe = &cluster->probes[i];
        const tl_surface *surface = refresh->request->ranges->surfaces[probe->surface];
        vec3s normal = surface->normals[probe->vertex];
        if (probe->back)
            normal = glms_vec3_negate(normal);
        vec3s origin =
            glms_vec3_add(surface->positions[probe->vertex], glms_vec3_scale(normal, refresh->offset_m));
        set_lane(lanes, i, origin, normal);
        lane_of[up.count] = i;
        push_ray(&up, lanes, i, normal);
    }
    uint32_t near = tl_trace_occluded_packet(refresh->request->trace, &up);
    for (int k = 0; k < up.count; k++) {
        int i = lane_of[k];
        /* A vertex without a normal has no outside from which to trace. */
        bool lost = lanes->nx[i] == 0 && lanes->ny[i] == 0 && lanes->nz[i] == 0;
        bool covered = lost || (near >> k & 1 && !lift(refresh, &cluster->probes[i], lanes, i));
        *cluster->covered = (uint16_t)((*cluster->covered & ~(1u << i)) | (uint32_t)covered << i);
    }
}

/* The largest cosine between a direction and the members' normals. */
TL_INLINE float max_cosine(const struct cluster_lanes *lanes, vec3s direction)
{
    float cosines[TL_CLUSTER];
    for (int i = 0; i < TL_CLUSTER; i++) /* lanes of no member hold zeros */
        cosines[i] = lanes->nx[i] * direction.x + lanes->ny[i] * direction.y + lanes->nz[i] * direction.z;
    float maximum = -1;
    for (int i = 0; i < TL_CLUSTER; i++)
        maximum = tl_maxf(maximum, lanes->members >> i & 1 ? cosines[i] : -1);
    return maximum;
}

/* The need of each region: its light on the cluster times the age of its value. Late regions also have their
 * age as a need of its own, 0 for all others. */
static void measure_needs(const struct tl_refresh *refresh, const struct tl_cluster *cluster,
                          const struct cluster_lanes *lanes, float needs[TL_REGIONS_MAX],
                          float late[TL_REGIONS_MAX])
{
    int count = refresh->request->regions->count, refreshed = refresh->request->params->refresh;
    uint32_t longest = (uint32_t)(LATE_ROUNDS * (count + refreshed - 1) / refreshed);
    for (int i = 0; i < count; i++) {
        float cosine = max_cosine(lanes, refresh->centres[i]);
        uint32_t age = refresh->frame - cluster->stamps[i];
        needs[i] = refresh->importances[i] * fmaxf(cosine + TL_SINE_BELOW, 0) * (float)age;
        late[i] = cosine > -TL_SINE_BELOW && age > longest ? (float)age : 0;
    }
}

/* Selects up to `wanted` more regions of greatest need, among equals the first. Returns how many. */
static int select_regions(const float needs[TL_REGIONS_MAX], int count, int wanted,
                          bool selected[TL_REGIONS_MAX])
{
    float maximum[TL_REGIONS_MAX]; /* so far, falling */
    int kept = 0;
    if (wanted <= 0)
        return 0;
    for (int i = 0; i < count; i++) {
        if (selected[i] || !(needs[i] > 0) || (kept == wanted && needs[i] <= maximum[kept - 1]))
            continue;
        int at = kept < wanted ? kept++ : kept - 1;
        for (; at > 0 && maximum[at - 1] < needs[i]; at--)
            maximum[at] = maximum[at - 1];
        maximum[at] = needs[i];
    }
    if (kept == 0)
        return 0;
    float minimum = maximum[kept - 1];
    int equals = 1;
    while (equals < kept && maximum[kept - 1 - equals] <= minimum)
        equals++;
    for (int i = 0; i < count; i++) {
        bool equal = !selected[i] && needs[i] == minimum && equals > 0;
        equals -= equal;
        selected[i] |= equal || needs[i] > minimum;
    }
    return kept;
}

static void select_in_motion(const struct tl_refresh *refresh, const struct tl_cluster *cluster,
                             const struct cluster_lanes *lanes, bool selected[TL_REGIONS_MAX])
{
    float needs[TL_REGIONS_MAX], late[TL_REGIONS_MAX];
    int count = refresh->request->regions->count, wanted = refresh->request->params->refresh;
    measure_needs(refresh, cluster, lanes, needs, late);
    wanted -= select_regions(late, count, (wanted + LATE_SHARE - 1) / LATE_SHARE, selected);
    select_regions(needs, count, wanted, selected);
}

/* Selects regions at rest by the same need as in motion, until each has had its rounds. Selects as many again
 * of those below the horizon: they cost hardly any rays, and a part of such a region may be above it. */
static void select_at_rest(const struct tl_refresh *refresh, const struct tl_cluster *cluster,
                           const struct cluster_lanes *lanes, bool selected[TL_REGIONS_MAX])
{
    float needs[TL_REGIONS_MAX], set[TL_REGIONS_MAX];
    int count = refresh->request->regions->count;
    int wanted = refresh->request->params->refresh;
    wanted = refresh->request->only_camera ? (wanted + 1) / 2 : TL_REST_RAY_FACTOR * wanted;
    measure_needs(refresh, cluster, lanes, needs, set);
    for (int i = 0; i < count; i++) {
        bool left = cluster->rounds[i] < refresh->request->params->rounds;
        set[i] = left && !(needs[i] > 0) ? (float)(refresh->frame - cluster->stamps[i]) : 0;
        needs[i] = left ? needs[i] : 0;
    }
    select_regions(needs, count, wanted, selected);
    select_regions(set, count, wanted, selected);
}

static void select_for(const struct tl_refresh *refresh, const struct tl_cluster *cluster,
                       const struct cluster_lanes *lanes, bool selected[TL_REGIONS_MAX])
{
    const struct tl_points_request *request = refresh->request;
    for (int i = 0; refresh->whole_rounds && i < request->regions->count; i++)
        selected[i] = request->moved || cluster->rounds[i] < request->params->rounds;
    if (refresh->whole_rounds)
        return;
    if (request->moved)
        select_in_motion(refresh, cluster, lanes, selected);
    else
        select_at_rest(refresh, cluster, lanes, selected);
}

/* The visibility of one region from a cluster's members in one frame. */
struct glance {
    float seen[TL_CLUSTER];   /* sum of weights x visibility */
    float weight[TL_CLUSTER]; /* sum of weights, in 1 / TL_WEIGHT_ONE */
};

/* Adds the visibility of a direction from each of `lanes_wanted`; returns the number of rays. Members whose
 * surface faces away are left out. */
static size_t trace_direction(const struct tl_refresh *refresh, const struct cluster_lanes *lanes,
                              uint32_t lanes_wanted, vec3s direction, struct glance *glance)
{
    struct tl_ray_packet bundle = {.to_m = INFINITY, .coherent = true};
    int lane_of[TL_CLUSTER];
    float through_ground[TL_CLUSTER];
    for (int i = 0; i < TL_CLUSTER; i++) {
        float cosine = glms_vec3_dot(lane_normal(lanes, i), direction);
        if (!(lanes_wanted >> i & 1) || cosine < -TL_SINE_BELOW)
            continue;
        float weight = visibility_weight(cosine);
        glance->weight[i] += weight;
        vec3s ahead = direction;
        if (cosine < 0) /* in the plane's mirror: see TL_SINE_BELOW */
            ahead = glms_vec3_sub(direction, glms_vec3_scale(lane_normal(lanes, i), 2 * cosine));
        float share = tl_ground_visibility(refresh->request->ground, lane_origin(lanes, i), direction);
        if (share <= 0)
            continue;
        through_ground[bundle.count] = share * weight;
        lane_of[bundle.count] = i;
        push_ray(&bundle, lanes, i, ahead);
    }
    if (bundle.count == 0)
        return 0;
    float seen[TL_CLUSTER];
    tl_trace_transmittance_packet(refresh->request->trace, &bundle, seen);
    for (int k = 0; k < bundle.count; k++)
        glance->seen[lane_of[k]] += through_ground[k] * seen[k];
    return (size_t)bundle.count;
}

/* Stores the new value: in motion it replaces the old one, at rest it is added to the mean. */
static void store(const struct tl_refresh *refresh, const struct tl_cluster *cluster, uint32_t lanes_wanted,
                  int region, const struct glance *glance)
{
    for (int i = 0; i < TL_CLUSTER; i++) {
        if (!(lanes_wanted >> i & 1))
            continue;
        size_t at = (size_t)i * refresh->stride + (size_t)region;
        float before = refresh->request->moved ? 0 : cluster->weights[at];
        float all = before + glance->weight[i], mean = cluster->values[at];
        mean = all > 0 ? (mean * before + TL_VISIBILITY_ONE * glance->seen[i]) / all : 0;
        cluster->values[at] = (uint16_t)(mean + 0.5f);
        cluster->weights[at] = (uint16_t)fminf(all, UINT16_MAX);
    }
}

static vec3s direction_of(const struct tl_refresh *refresh, const struct tl_cluster *cluster, int region,
                          int round, int ray)
{
    const struct tl_points_request *request = refresh->request;
    const int rays = request->params->rays, run = rays * request->params->rounds;
    if (refresh->directions)
        return refresh->directions[region * rays + ray];
    const uint32_t first = (uint32_t)(cluster->number % DIRECTION_RUNS) * (uint32_t)run;
    const uint32_t number = first + (uint32_t)(round * rays + ray);
    return tl_turn_direction(tl_region_sample(request->regions, region, number), request->environment_yaw);
}

static size_t trace_region(const struct tl_refresh *refresh, const struct tl_cluster *cluster,
                           const struct cluster_lanes *lanes, uint32_t lanes_wanted, int region, int round)
{
    int ray_count = refresh->request->params->rays;
    struct glance glance = {0};
    size_t rays = 0;
    for (int k = 0; k < ray_count; k++)
        rays += trace_direction(refresh, lanes, lanes_wanted,
                                direction_of(refresh, cluster, region, round, k), &glance);
    store(refresh, cluster, lanes_wanted, region, &glance);
    return rays;
}

int tl_cluster_rounds(const struct tl_refresh *refresh, const struct tl_cluster *cluster)
{
    int minimum = cluster->rounds[0];
    for (int i = 1; i < refresh->request->regions->count; i++)
        minimum = cluster->rounds[i] < minimum ? cluster->rounds[i] : minimum;
    return minimum;
}

size_t tl_cluster_refresh(const struct tl_refresh *refresh, const struct tl_cluster *cluster)
{
    bool selected[TL_REGIONS_MAX] = {0}, counts = refresh->whole_rounds || !refresh->request->moved;
    struct cluster_lanes lanes;
    size_t rays = 0;
    place_members(refresh, cluster, &lanes);
    select_for(refresh, cluster, &lanes, selected);
    for (int i = 0; i < refresh->request->regions->count; i++) {
        uint32_t lanes_wanted = selected[i] ? cluster->members : cluster->fresh;
        if (!lanes_wanted)
            continue;
        /* Until it has a round of its own, a new member sees what none of these rounds does. */
        const int round = selected[i] ? cluster->rounds[i] : refresh->request->params->rounds;
        rays += trace_region(refresh, cluster, &lanes, lanes_wanted, i, round);
        if (lanes_wanted == cluster->members)
            cluster->stamps[i] = refresh->frame;
        cluster->rounds[i] = (uint16_t)(cluster->rounds[i] + (selected[i] && counts));
    }
    return rays;
}

size_t tl_places_trace(const struct tl_refresh *refresh, size_t bundle, int round, const vec3s *origins,
                       const vec3s *normals, int count, uint16_t *values, uint16_t *weights)
{
    struct cluster_lanes lanes = {.members = (1u << count) - 1};
    const struct tl_cluster cluster = {
        .number = bundle, .members = lanes.members, .values = values, .weights = weights};
    size_t rays = 0;
    for (int i = 0; i < count; i++)
        set_lane(&lanes, i, origins[i], normals[i]);
    for (int i = 0; i < refresh->request->regions->count; i++)
        rays += trace_region(refresh, &cluster, &lanes, lanes.members, i, round);
    return rays;
}
