#include "cloth/self_contact/near.h"

#include "cloth/self_contact/closest.h"
#include "config/base/memory.h"

#include <stdlib.h>
#include <string.h>

/* Rounding of the distance of two points to single precision, as a share of the largest coordinate: two
 * points with three coordinates each, and their difference. */
#define ROUND_SHARE 4e-7f
/* Spokes that have changed by less, as a share of what a hub needs to be open, are not measured again. */
#define LEAST_CHANGE 0.05

static uint32_t next_corner(uint32_t corner, uint32_t by)
{
    return (corner + by) % 3;
}

/* ---- Building ---- */

/* Assigns every vertex and every edge to the first triangle that has it, so that a pair of features is found
 * with one pair of triangles only. */
static uint8_t *assign_owners(const struct tl_topology *topology)
{
    uint8_t *owns = TL_NEW_ARRAY(uint8_t, topology->triangle_count);
    bool *vertex_owned = TL_NEW_ARRAY(bool, topology->vertex_count);
    bool *edge_owned = TL_NEW_ARRAY(bool, topology->edge_count);
    for (size_t t = 0; t < topology->triangle_count; t++)
        for (uint32_t i = 0; i < 3; i++) {
            const uint32_t *v = topology->triangles[t];
            uint32_t edge = tl_topology_edge(topology, v[next_corner(i, 1)], v[next_corner(i, 2)]);
            owns[t] |= (uint8_t)(!vertex_owned[v[i]] << i | !edge_owned[edge] << (3 + i));
            vertex_owned[v[i]] = edge_owned[edge] = true;
        }
    free(vertex_owned);
    free(edge_owned);
    return owns;
}

static void find_rings(struct tl_near *near)
{
    const struct tl_topology *topology = near->topology;
    size_t count = topology->vertex_count;
    near->ring_first = TL_NEW_ARRAY(uint32_t, count + 1);
    near->ring = TL_NEW_ARRAY(uint32_t, 2 * topology->edge_count);
    near->spokes = TL_NEW_ARRAY(vec3d, 2 * topology->edge_count);
    struct tl_fans ends = tl_fans_build((const uint32_t *)topology->edges, 2 * topology->edge_count, count);
    for (size_t i = 0; i < count; i++)
        for (uint32_t k = ends.first[i]; k < ends.first[i + 1]; k++)
            near->ring[k] = topology->edges[ends.items[k] / 2][1 - ends.items[k] % 2];
    memcpy(near->ring_first, ends.first, (count + 1) * sizeof *ends.first);
    tl_fans_release(&ends);
}

struct tl_near tl_near_create(const struct tl_topology *topology, const uint32_t *class_of, const vec3d *x)
{
    size_t count = topology->vertex_count, corners = 3 * topology->triangle_count;
    struct tl_near near = {.topology = topology,
                           .tree = tl_near_tree_create(topology, x),
                           .class_of = TL_NEW_ARRAY(uint32_t, count),
                           .owns = assign_owners(topology),
                           .fans = tl_fans_build((const uint32_t *)topology->triangles, corners, count),
                           .clear = TL_NEW_ARRAY(double, count),
                           .across = TL_NEW_ARRAY(uint32_t, count),
                           .ranges = TL_NEW_ARRAY(double, topology->triangle_count),
                           .open = TL_NEW_ARRAY(bool, count),
                           .at = tl_alloc(count, sizeof(float[3])),
                           .base = TL_NEW_ARRAY(vec3d, count),
                           .reach = TL_NEW_ARRAY(double, count)};
    memcpy(near.class_of, class_of, count * sizeof *class_of);
    find_rings(&near);
    return near;
}

void tl_near_release(struct tl_near *near)
{
    tl_near_tree_release(&near->tree);
    tl_fans_release(&near->fans);
    free(near->class_of);
    free(near->owns);
    free(near->clear);
    free(near->ring_first);
    free(near->ring);
    free(near->across);
    free(near->spokes);
    free(near->ranges);
    free(near->open);
    free(near->at);
    free(near->base);
    free(near->reach);
    free(near->pairs);
    *near = (struct tl_near){0};
}

/* ---- Features ---- */

vec3d tl_near_closest(const struct tl_near_pair *pair, const vec3d *x, double weights[4])
{
    const vec3d at[4] = {x[pair->v[0]], x[pair->v[1]], x[pair->v[2]], x[pair->v[3]]};
    if (pair->edges) {
        tl_closest_on_segments(at[0], at[1], at[2], at[3], &weights[1], &weights[3]);
        weights[0] = 1 - weights[1];
        weights[2] = 1 - weights[3];
        vec3d from = vec3d_mix(at[0], at[1], weights[1]), to = vec3d_mix(at[2], at[3], weights[3]);
        return vec3d_sub(to, from);
    }
    weights[0] = 1;
    tl_closest_on_triangle(at[0], at[1], at[2], at[3], &weights[1]);
    vec3d to = vec3d_scale(at[1], weights[1]);
    to = vec3d_muladd(vec3d_muladd(to, at[2], weights[2]), at[3], weights[3]);
    return vec3d_sub(to, at[0]);
}

static bool touches(const struct tl_near *near, const struct tl_near_pair *pair)
{
    const uint32_t *class_of = near->class_of;
    int second = tl_near_second(pair);
    for (int i = 0; i < second; i++)
        for (int k = second; k < 4; k++)
            if (class_of[pair->v[i]] == class_of[pair->v[k]])
                return true;
    return false;
}

static struct tl_near_pair corner_and_triangle(const uint32_t a[3], uint32_t corner, const uint32_t b[3])
{
    return (struct tl_near_pair){.v = {a[corner], b[0], b[1], b[2]}};
}

/* The sides that face a corner of each. */
static struct tl_near_pair two_sides(const uint32_t a[3], uint32_t corner, const uint32_t b[3],
                                     uint32_t other)
{
    return (struct tl_near_pair){.v = {a[next_corner(corner, 1)], a[next_corner(corner, 2)],
                                       b[next_corner(other, 1)], b[next_corner(other, 2)]},
                                 .edges = true};
}

/* ---- Batches ---- */

/* Pairs of one kind whose distances are computed together. */
struct near_batch {
    int count;
    struct tl_near_pair pairs[TL_LANES];
    struct tl_closest_lanes lanes;
};

/* Returns whether the batch is full. */
static bool add_to_batch(const struct tl_near *near, struct tl_near_pair pair, struct near_batch *batch)
{
    int lane = batch->count++;
    batch->pairs[lane] = pair;
    for (int i = 0; i < 4; i++)
        for (int axis = 0; axis < 3; axis++)
            batch->lanes.point[i][axis][lane] = near->at[pair.v[i]][axis];
    return batch->count == TL_LANES;
}

/* Lower bounds of the pairs' distances; lanes beyond the batch's count have none. */
static void bound_batch(const struct tl_near *near, const struct near_batch *batch, float bounds[TL_LANES])
{
    if (batch->pairs[0].edges)
        tl_closest_segment_bounds(&batch->lanes, bounds);
    else
        tl_closest_triangle_bounds(&batch->lanes, bounds);
    for (int i = 0; i < TL_LANES; i++)
        bounds[i] -= near->rounding;
}

/* ---- Hubs ---- */

/* A hub's triangle k: its corners, the first of which is the hub. */
static void fan_triangle(const struct tl_near *near, uint32_t item, uint32_t out[3])
{
    uint32_t corner = near->fans.items[item];
    const uint32_t *v = near->topology->triangles[corner / 3];
    for (uint32_t i = 0; i < 3; i++)
        out[i] = v[next_corner(corner % 3, i)];
}

/* Axes that turn with the hub: along its first spoke, and in the plane of that and another. Any orthonormal
 * axes are right; such as turn with the cloth make the spokes change little. */
static void hub_axes(const struct tl_near *near, uint32_t hub, const vec3d *x, vec3d axes[3])
{
    vec3d side = vec3d_sub(x[near->ring[near->ring_first[hub]]], x[hub]);
    vec3d other = vec3d_sub(x[near->ring[near->across[hub]]], x[hub]);
    axes[0] = vec3d_unit_or(side, (vec3d){1, 0, 0});
    vec3d least = fabs(axes[0].x) < 0.7 ? (vec3d){1, 0, 0} : (vec3d){0, 1, 0};
    vec3d normal = vec3d_cross(axes[0], other);
    if (!(vec3d_dot(normal, normal) > 1e-12 * vec3d_dot(other, other)))
        normal = vec3d_cross(axes[0], least);
    axes[1] = vec3d_unit_or(normal, (vec3d){0, 0, 1});
    axes[2] = vec3d_cross(axes[0], axes[1]);
}

static vec3d in_axes(const vec3d axes[3], vec3d v)
{
    return (vec3d){vec3d_dot(axes[0], v), vec3d_dot(axes[1], v), vec3d_dot(axes[2], v)};
}

/* The largest change of a spoke since the measurement. */
static double spoke_change(const struct tl_near *near, uint32_t hub, const vec3d *x)
{
    vec3d axes[3];
    double most = 0;
    hub_axes(near, hub, x, axes);
    for (uint32_t k = near->ring_first[hub]; k < near->ring_first[hub + 1]; k++) {
        vec3d now = in_axes(axes, vec3d_sub(x[near->ring[k]], x[hub]));
        vec3d change = vec3d_sub(now, near->spokes[k]);
        most = tl_max(most, vec3d_dot(change, change));
    }
    return sqrt(most);
}

static void measure_spokes(struct tl_near *near, uint32_t hub, const vec3d *x)
{
    uint32_t from = near->ring_first[hub];
    vec3d axes[3], first = vec3d_sub(x[near->ring[from]], x[hub]);
    double best = -1;
    for (uint32_t k = from; k < near->ring_first[hub + 1]; k++) {
        vec3d across = vec3d_cross(first, vec3d_sub(x[near->ring[k]], x[hub]));
        double size = vec3d_dot(across, across);
        near->across[hub] = size > best ? k : near->across[hub];
        best = tl_max(best, size);
    }
    hub_axes(near, hub, x, axes);
    for (uint32_t k = from; k < near->ring_first[hub + 1]; k++)
        near->spokes[k] = in_axes(axes, vec3d_sub(x[near->ring[k]], x[hub]));
}

/* Lowers `minimum` to the bounds of a batch, and empties it. */
static void take_minimum(const struct tl_near *near, struct near_batch *batch, double *minimum)
{
    float bounds[TL_LANES];
    if (batch->count == 0)
        return;
    bound_batch(near, batch, bounds);
    for (int i = 0; i < batch->count; i++)
        *minimum = tl_min(*minimum, (double)bounds[i]);
    batch->count = 0;
}

/* Nearest distance of features of two triangles around one hub (their corner 0) that do not touch: their far
 * corners and triangles, and pairs of sides of which one or more face the hub. */
static void clear_between(const struct tl_near *near, const uint32_t a[3], const uint32_t b[3],
                          struct near_batch batches[2], double *minimum)
{
    const struct tl_near_pair pairs[] = {
        corner_and_triangle(a, 1, b), corner_and_triangle(a, 2, b), corner_and_triangle(b, 1, a),
        corner_and_triangle(b, 2, a), two_sides(a, 0, b, 0),        two_sides(a, 0, b, 1),
        two_sides(a, 0, b, 2),        two_sides(a, 1, b, 0),        two_sides(a, 2, b, 0)};
    for (size_t i = 0; i < TL_COUNT(pairs); i++) {
        struct near_batch *batch = &batches[pairs[i].edges];
        if (!touches(near, &pairs[i]) && add_to_batch(near, pairs[i], batch))
            take_minimum(near, batch, minimum);
    }
}

static void measure_hub(struct tl_near *near, uint32_t hub, const vec3d *x)
{
    double minimum = HUGE_VAL;
    struct near_batch batches[2];
    batches[0].count = batches[1].count = 0;
    measure_spokes(near, hub, x);
    for (uint32_t k = near->fans.first[hub]; k < near->fans.first[hub + 1]; k++) {
        uint32_t a[3], b[3];
        fan_triangle(near, k, a);
        for (uint32_t m = near->fans.first[hub]; m < k; m++) {
            fan_triangle(near, m, b);
            clear_between(near, a, b, batches, &minimum);
        }
    }
    for (int i = 0; i < 2; i++)
        take_minimum(near, &batches[i], &minimum);
    near->clear[hub] = minimum;
}

/* The distance by which features around a hub can come nearer, in all. */
static double hub_reach(const struct tl_near *near, uint32_t hub)
{
    double most = near->reach[hub];
    for (uint32_t k = near->ring_first[hub]; k < near->ring_first[hub + 1]; k++)
        most = tl_max(most, near->reach[near->ring[k]]);
    return 2 * most + near->margin;
}

/* Measures again only where that could open the hub and the spokes have changed enough for a new result. */
static void open_hub(struct tl_near *near, uint32_t hub, const vec3d *x)
{
    double needed = hub_reach(near, hub);
    if (near->ring_first[hub] == near->ring_first[hub + 1])
        return;
    bool measured = near->clear[hub] > 0;
    double change = measured ? spoke_change(near, hub, x) : HUGE_VAL;
    near->open[hub] = measured && near->clear[hub] - 2 * change > needed;
    if (near->open[hub] || near->clear[hub] + 2 * change <= needed || change < LEAST_CHANGE * needed)
        return;
    measure_hub(near, hub, x);
    near->open[hub] = near->clear[hub] > needed;
}

/* ---- Listing ---- */

struct near_list {
    size_t count, capacity;
    struct tl_near_pair *pairs;
    struct near_batch batches[2]; /* of vertices and triangles, of edges */
};

static void make_room(struct near_list *list, size_t more)
{
    if (list->count + more <= list->capacity)
        return;
    list->capacity = 2 * list->capacity + more + 64;
    list->pairs = tl_resize(list->pairs, list->capacity, sizeof *list->pairs);
}

static double feature_reach(const double *reach, const uint32_t *v, int from, int to)
{
    double most = 0;
    for (int i = from; i < to; i++)
        most = tl_max(most, reach[v[i]]);
    return most;
}

/* Appends the pairs of a batch that are near enough, and empties it. */
static void end_batch(const struct tl_near *near, struct near_list *out, struct near_batch *batch)
{
    float bounds[TL_LANES];
    if (batch->count == 0)
        return;
    bound_batch(near, batch, bounds);
    make_room(out, TL_LANES);
    for (int i = 0; i < batch->count; i++) {
        struct tl_near_pair pair = batch->pairs[i];
        int second = tl_near_second(&pair);
        double most = near->margin + feature_reach(near->reach, pair.v, 0, second) +
                      feature_reach(near->reach, pair.v, second, 4);
        pair.distance = bounds[i];
        if ((double)pair.distance <= most)
            out->pairs[out->count++] = pair;
    }
    batch->count = 0;
}

static void try_pair(const struct tl_near *near, struct tl_near_pair pair, struct near_list *out)
{
    struct near_batch *batch = &out->batches[pair.edges];
    if (touches(near, &pair))
        return;
    pair.kept = -1;
    if (add_to_batch(near, pair, batch))
        end_batch(near, out, batch);
}

/* Whether a plane across `along` separates two triangles, the first below, by more than `most` metres. */
static bool plane_parts(const uint32_t a[3], const uint32_t b[3], vec3d along, double most, const vec3d *x)
{
    double below = vec3d_dot(along, x[a[0]]), above = vec3d_dot(along, x[b[0]]);
    for (int i = 1; i < 3; i++) {
        below = tl_max(below, vec3d_dot(along, x[a[i]]));
        above = tl_min(above, vec3d_dot(along, x[b[i]]));
    }
    double gap = above - below;
    return gap > 0 && gap * gap > most * most * vec3d_dot(along, along);
}

/* Whether two triangles are farther apart than their reach: along the line between their centres, or, as
 * layers are, along the first one's normal. */
static bool are_beyond_reach(const struct tl_near *near, uint32_t first, uint32_t second, const vec3d *x)
{
    const uint32_t *a = near->topology->triangles[first], *b = near->topology->triangles[second];
    vec3d along = vec3d_sub(vec3d_add(vec3d_add(x[b[0]], x[b[1]]), x[b[2]]),
                            vec3d_add(vec3d_add(x[a[0]], x[a[1]]), x[a[2]]));
    double most = near->margin + near->ranges[first] + near->ranges[second];
    if (plane_parts(a, b, along, most, x))
        return true;
    vec3d normal = vec3d_cross(vec3d_sub(x[a[1]], x[a[0]]), vec3d_sub(x[a[2]], x[a[0]]));
    return plane_parts(a, b, vec3d_scale(normal, vec3d_dot(normal, along) < 0 ? -1 : 1), most, x);
}

static void list_features(const struct tl_near *near, uint32_t first, uint32_t second, const vec3d *x,
                          struct near_list *out)
{
    const uint32_t *a = near->topology->triangles[first], *b = near->topology->triangles[second];
    unsigned owns_a = near->owns[first], owns_b = near->owns[second];
    if (are_beyond_reach(near, first, second, x))
        return;
    for (uint32_t i = 0; i < 3; i++) {
        if (owns_a >> i & 1)
            try_pair(near, corner_and_triangle(a, i, b), out);
        if (owns_b >> i & 1)
            try_pair(near, corner_and_triangle(b, i, a), out);
        for (uint32_t k = 0; k < 3 && owns_a >> (3 + i) & 1; k++)
            if (owns_b >> (3 + k) & 1)
                try_pair(near, two_sides(a, i, b, k), out);
    }
}

static void list_task(const struct tl_near *near, size_t task, const vec3d *x, struct near_list *out)
{
    struct tl_near_pairs pairs = {0};
    tl_near_tree_pairs(&near->tree, task, &pairs);
    for (size_t i = 0; i < pairs.count; i++)
        list_features(near, pairs.pairs[i][0], pairs.pairs[i][1], x, out);
    for (size_t i = 0; i < TL_COUNT(out->batches); i++)
        end_batch(near, out, &out->batches[i]);
    tl_near_pairs_release(&pairs);
}

/* Joins the tasks' lists in the order of the tasks. */
static void join_lists(struct tl_near *near, struct near_list *lists)
{
    size_t total = 0;
    for (size_t task = 0; task < near->tree.task_count; task++)
        total += lists[task].count;
    if (total > near->pair_capacity) {
        near->pair_capacity = 2 * total;
        near->pairs = tl_resize(near->pairs, near->pair_capacity, sizeof *near->pairs);
    }
    near->pair_count = 0;
    for (size_t task = 0; task < near->tree.task_count; task++) {
        if (lists[task].count > 0)
            memcpy(near->pairs + near->pair_count, lists[task].pairs,
                   lists[task].count * sizeof *near->pairs);
        near->pair_count += lists[task].count;
        free(lists[task].pairs);
    }
}

/* Positions in single precision, from an origin near the cloth. */
static void round_positions(struct tl_near *near, const vec3d *x)
{
    size_t count = near->topology->vertex_count;
    float largest = 0;
    for (size_t i = 0; i < count; i++) {
        vec3d from = vec3d_sub(x[i], x[0]);
        const double p[3] = {from.x, from.y, from.z};
        for (int axis = 0; axis < 3; axis++) {
            near->at[i][axis] = (float)p[axis];
            largest = tl_maxf(largest, fabsf(near->at[i][axis]));
        }
    }
    near->rounding = ROUND_SHARE * largest;
}

void tl_near_list(struct tl_near *near, const vec3d *x)
{
    size_t count = near->topology->vertex_count;
    double *margins = TL_NEW_ARRAY(double, count);
    struct near_list *lists = TL_NEW_ARRAY(struct near_list, near->tree.task_count);
    memcpy(near->base, x, count * sizeof *x);
    round_positions(near, x);
#pragma omp parallel if (count >= TL_NEAR_PARALLEL_VERTICES)
    {
#pragma omp for schedule(static)
        for (size_t i = 0; i < count; i++) {
            margins[i] = near->reach[i] + near->margin / 2;
            open_hub(near, (uint32_t)i, x);
        }
#pragma omp for schedule(static)
        for (size_t t = 0; t < near->topology->triangle_count; t++)
            near->ranges[t] = feature_reach(near->reach, near->topology->triangles[t], 0, 3);
    }
    tl_near_tree_refit(&near->tree, near->topology, x, margins, near->open);
#pragma omp parallel for schedule(dynamic) if (count >= TL_NEAR_PARALLEL_VERTICES)
    for (size_t task = 0; task < near->tree.task_count; task++)
        list_task(near, task, x, &lists[task]);
    join_lists(near, lists);
    free(lists);
    free(margins);
    near->listed = true;
}
