#include "cloth/self_contact/near_tree.h"

#include "config/base/memory.h"
#include "config/base/simd.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Nodes of the level whose pairs are tasks. */
#define TASK_NODES 16
/* Relative and absolute rounding of a box outwards: more than float rounding of its coordinates. */
#define ROUND_RELATIVE 3e-7f
#define ROUND_M        1e-7f

/* ---- Building ---- */

struct placed_triangle {
    double centre[3];
    uint32_t triangle;
};

static int compare_placed(const void *a, const void *b, void *axis)
{
    const struct placed_triangle *left = a, *right = b;
    double difference = left->centre[*(const int *)axis] - right->centre[*(const int *)axis];
    if (difference != 0)
        return difference < 0 ? -1 : 1;
    return (left->triangle > right->triangle) - (left->triangle < right->triangle);
}

static int longest_axis(const struct placed_triangle *placed, size_t count)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < count; i++)
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = fmin(low[axis], placed[i].centre[axis]);
            high[axis] = fmax(high[axis], placed[i].centre[axis]);
        }
    int longest = 0;
    for (int axis = 1; axis < 3; axis++)
        longest = high[axis] - low[axis] > high[longest] - low[longest] ? axis : longest;
    return longest;
}

/* Divides triangles evenly between two halves of `leaf_count` leaves, along their longest extent. */
static void place(struct placed_triangle *placed, size_t count, struct tl_near_leaf *leaves,
                  size_t leaf_count)
{
    if (leaf_count == 1) {
        for (size_t lane = 0; lane < TL_NEAR_LEAF; lane++)
            leaves->triangles[lane] = lane < count ? placed[lane].triangle : TL_NONE;
        return;
    }
    int axis = longest_axis(placed, count);
    qsort_r(placed, count, sizeof *placed, compare_placed, &axis);
    size_t half = count / 2;
    place(placed, half, leaves, leaf_count / 2);
    place(placed + half, count - half, leaves + leaf_count / 2, leaf_count / 2);
}

static void make_tasks(struct tl_near_tree *tree)
{
    uint32_t nodes = tree->leaf_count < TASK_NODES ? (uint32_t)tree->leaf_count : TASK_NODES;
    tree->tasks = tl_alloc((size_t)nodes * (nodes + 1) / 2, sizeof *tree->tasks);
    for (uint32_t a = 0; a < nodes; a++)
        for (uint32_t b = a; b < nodes; b++) {
            tree->tasks[tree->task_count][0] = nodes + a;
            tree->tasks[tree->task_count++][1] = nodes + b;
        }
}

struct tl_near_tree tl_near_tree_create(const struct tl_topology *topology, const vec3d *x)
{
    size_t count = topology->triangle_count;
    struct tl_near_tree tree = {.leaf_count = 1};
    while (tree.leaf_count * TL_NEAR_LEAF < count)
        tree.leaf_count *= 2;
    tree.leaves = tl_alloc_lines(tree.leaf_count, sizeof *tree.leaves);
    tree.nodes = tl_alloc_lines(2 * tree.leaf_count, sizeof *tree.nodes);
    struct placed_triangle *placed = TL_NEW_ARRAY(struct placed_triangle, count);
    for (size_t t = 0; t < count; t++) {
        const uint32_t *v = topology->triangles[t];
        vec3d sum = vec3d_add(vec3d_add(x[v[0]], x[v[1]]), x[v[2]]);
        placed[t] = (struct placed_triangle){{sum.x, sum.y, sum.z}, (uint32_t)t};
    }
    place(placed, count, tree.leaves, tree.leaf_count);
    free(placed);
    make_tasks(&tree);
    return tree;
}

void tl_near_tree_release(struct tl_near_tree *tree)
{
    free(tree->leaves);
    free(tree->nodes);
    free(tree->tasks);
    *tree = (struct tl_near_tree){0};
}

/* ---- Refitting ---- */

static const struct tl_near_box nothing = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};

TL_INLINE float round_down(double x)
{
    float f = (float)x;
    return f - fabsf(f) * ROUND_RELATIVE - ROUND_M;
}

TL_INLINE float round_up(double x)
{
    float f = (float)x;
    return f + fabsf(f) * ROUND_RELATIVE + ROUND_M;
}

static void fit_lane(struct tl_near_leaf *leaf, int lane, const uint32_t v[3], const vec3d *x,
                     const double *margins, vec3d origin)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int corner = 0; corner < 3; corner++) {
        vec3d at = vec3d_sub(x[v[corner]], origin);
        double margin = margins ? margins[v[corner]] : 0;
        const double p[3] = {at.x, at.y, at.z};
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = p[axis] - margin < low[axis] ? p[axis] - margin : low[axis];
            high[axis] = p[axis] + margin > high[axis] ? p[axis] + margin : high[axis];
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        leaf->low[axis][lane] = round_down(low[axis]);
        leaf->high[axis][lane] = round_up(high[axis]);
    }
}

static void fit_leaf(struct tl_near_leaf *leaf, struct tl_near_box *node, const struct tl_topology *topology,
                     const vec3d *x, const double *margins, const bool *open, vec3d origin)
{
    *node = nothing;
    for (int lane = 0; lane < TL_NEAR_LEAF; lane++) {
        uint32_t triangle = leaf->triangles[lane];
        if (triangle != TL_NONE)
            fit_lane(leaf, lane, topology->triangles[triangle], x, margins, origin);
        for (int corner = 0; corner < 3; corner++) {
            uint32_t v = triangle != TL_NONE ? topology->triangles[triangle][corner] : TL_NONE;
            leaf->open[corner][lane] = v != TL_NONE && open && open[v] ? v : TL_NONE;
        }
        for (int axis = 0; axis < 3 && leaf->triangles[lane] == TL_NONE; axis++) {
            leaf->low[axis][lane] = FLT_MAX;
            leaf->high[axis][lane] = -FLT_MAX;
        }
        for (int axis = 0; axis < 3; axis++) {
            node->low[axis] = tl_minf(node->low[axis], leaf->low[axis][lane]);
            node->high[axis] = tl_maxf(node->high[axis], leaf->high[axis][lane]);
        }
    }
}

void tl_near_tree_refit(struct tl_near_tree *tree, const struct tl_topology *topology, const vec3d *x,
                        const double *margins, const bool *open)
{
    vec3d origin = topology->vertex_count > 0 ? x[0] : (vec3d){0};
#pragma omp parallel for if (topology->vertex_count >= TL_NEAR_PARALLEL_VERTICES)
    for (size_t i = 0; i < tree->leaf_count; i++)
        fit_leaf(&tree->leaves[i], &tree->nodes[tree->leaf_count + i], topology, x, margins, open, origin);
    for (size_t i = tree->leaf_count - 1; i > 0; i--)
        for (int axis = 0; axis < 3; axis++) {
            const struct tl_near_box *a = &tree->nodes[2 * i], *b = &tree->nodes[2 * i + 1];
            tree->nodes[i].low[axis] = tl_minf(a->low[axis], b->low[axis]);
            tree->nodes[i].high[axis] = tl_maxf(a->high[axis], b->high[axis]);
        }
}

/* ---- Traversal ---- */

static bool boxes_overlap(const struct tl_near_box *a, const struct tl_near_box *b)
{
    return (a->low[0] <= b->high[0]) & (b->low[0] <= a->high[0]) & (a->low[1] <= b->high[1]) &
           (b->low[1] <= a->high[1]) & (a->low[2] <= b->high[2]) & (b->low[2] <= a->high[2]);
}

/* Appends the overlapping pairs of two leaves to `out`, which has room for all; returns their number. In a
 * leaf with itself each pair is taken once. */
TL_CLONES static size_t pair_leaves(const struct tl_near_leaf *a, const struct tl_near_leaf *b,
                                    const struct tl_near_box *box_b, uint32_t (*out)[2])
{
    size_t count = 0;
    for (int lane = 0; lane < TL_NEAR_LEAF; lane++) {
        float low[3], high[3];
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = a->low[axis][lane];
            high[axis] = a->high[axis][lane];
        }
        bool away = (low[0] > box_b->high[0]) | (high[0] < box_b->low[0]) | (low[1] > box_b->high[1]) |
                    (high[1] < box_b->low[1]) | (low[2] > box_b->high[2]) | (high[2] < box_b->low[2]);
        if (away)
            continue;
        uint32_t hit[TL_NEAR_LEAF], any = 0, open[3];
        for (int corner = 0; corner < 3; corner++) /* TL_NONE equals nothing */
            open[corner] = a->open[corner][lane] == TL_NONE ? TL_NONE - 1 : a->open[corner][lane];
        for (int k = 0; k < TL_NEAR_LEAF; k++)
            hit[k] = (low[0] <= b->high[0][k]) & (b->low[0][k] <= high[0]) & (low[1] <= b->high[1][k]) &
                     (b->low[1][k] <= high[1]) & (low[2] <= b->high[2][k]) & (b->low[2][k] <= high[2]);
        for (int corner = 0; corner < 3; corner++)
            for (int k = 0; k < TL_NEAR_LEAF; k++)
                hit[k] &= (b->open[corner][k] != open[0]) & (b->open[corner][k] != open[1]) &
                          (b->open[corner][k] != open[2]);
        for (int k = 0; k < TL_NEAR_LEAF; k++)
            any |= hit[k];
        for (int k = a == b ? lane + 1 : 0; any && k < TL_NEAR_LEAF; k++) {
            out[count][0] = a->triangles[lane];
            out[count][1] = b->triangles[k];
            count += hit[k];
        }
    }
    return count;
}

static void make_room(struct tl_near_pairs *pairs, size_t more)
{
    if (pairs->count + more <= pairs->capacity)
        return;
    pairs->capacity = 2 * pairs->capacity + more;
    pairs->pairs = tl_resize(pairs->pairs, pairs->capacity, sizeof *pairs->pairs);
}

void tl_near_pairs_append(struct tl_near_pairs *pairs, const struct tl_near_pairs *more)
{
    make_room(pairs, more->count);
    if (more->count > 0)
        memcpy(pairs->pairs + pairs->count, more->pairs, more->count * sizeof *more->pairs);
    pairs->count += more->count;
}

void tl_near_pairs_release(struct tl_near_pairs *pairs)
{
    free(pairs->pairs);
    *pairs = (struct tl_near_pairs){0};
}

static void add_leaves(const struct tl_near_tree *tree, uint32_t a, uint32_t b, struct tl_near_pairs *out)
{
    make_room(out, TL_NEAR_LEAF * TL_NEAR_LEAF + 1); /* one more, which is written and not counted */
    size_t first = tree->leaf_count;
    out->count += pair_leaves(&tree->leaves[a - first], &tree->leaves[b - first], &tree->nodes[b],
                              out->pairs + out->count);
}

static void descend(const struct tl_near_tree *tree, uint32_t a, uint32_t b, struct tl_near_pairs *out)
{
    if (!boxes_overlap(&tree->nodes[a], &tree->nodes[b]) || (out->limit > 0 && out->count >= out->limit))
        return;
    if (a >= tree->leaf_count) {
        add_leaves(tree, a, b, out);
        return;
    }
    descend(tree, 2 * a, 2 * b, out);
    descend(tree, 2 * a, 2 * b + 1, out);
    if (a != b)
        descend(tree, 2 * a + 1, 2 * b, out);
    descend(tree, 2 * a + 1, 2 * b + 1, out);
}

void tl_near_tree_pairs(const struct tl_near_tree *tree, size_t task, struct tl_near_pairs *out)
{
    out->count = 0;
    descend(tree, tree->tasks[task][0], tree->tasks[task][1], out);
    out->cut_short = out->limit > 0 && out->count >= out->limit;
}
