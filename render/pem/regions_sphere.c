#include "config/base/memory.h"
#include "render/pem/regions_internal.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Candidate positions of a cut along the axis of a node: much finer than the parts, so that no cut divides a
 * compact light. */
#define BINS 256

/* Texels in a structure of arrays; those of a node are contiguous. `weight` is the mixed measure: half of the
 * texel's share of all luminance and half of its share of the sphere. */
struct sphere_points {
    float *x, *y, *z, *weight;
    uint32_t *texel;
};

/* Weighted sums over the directions d of a node: 1, d, and d d^T. */
struct moments {
    double weight, mean[3];
    double xx, yy, zz, xy, xz, yz;
};

/* A node of the growing tree. All nodes of a depth come before those of the next depth, left before right, so
 * that the order of two nodes does not depend on the number of others. */
struct growth {
    uint32_t first, last; /* its points */
    struct moments moments;
    double variance; /* weighted sum of squared distances from the centroid; at most that of the parent */
    int parent, children[2];
    int rank;
};

struct tree {
    struct sphere_points points, spare;
    float *along; /* coordinate of each point on the axis of its node */
    struct growth *nodes;
    int count, capacity;
};

static struct sphere_points points_create(size_t count)
{
    return (struct sphere_points){.x = TL_NEW_ARRAY(float, count),
                                  .y = TL_NEW_ARRAY(float, count),
                                  .z = TL_NEW_ARRAY(float, count),
                                  .weight = TL_NEW_ARRAY(float, count),
                                  .texel = TL_NEW_ARRAY(uint32_t, count)};
}

static void points_release(struct sphere_points *points)
{
    free(points->x);
    free(points->y);
    free(points->z);
    free(points->weight);
    free(points->texel);
}

static void fill_points(const struct tl_regions *regions, struct sphere_points *points)
{
    size_t face_texels = (size_t)regions->size * (size_t)regions->size;
    double luminance = 0;
    for (size_t i = 0; i < 6 * face_texels; i++)
        luminance += (double)regions->importance[i];
#pragma omp parallel for if (6 * face_texels >= TL_REGIONS_PARALLEL_TEXELS)
    for (size_t i = 0; i < 6 * face_texels; i++) {
        double area = (double)regions->solid_angles[i % face_texels] / (4 * M_PI);
        double light = luminance > 0 ? (double)regions->importance[i] / luminance : area;
        vec3s direction = tl_cube_texel_direction(regions->size, (int)i);
        points->x[i] = direction.x;
        points->y[i] = direction.y;
        points->z[i] = direction.z;
        points->weight[i] = (float)(0.5 * (area + light));
        points->texel[i] = (uint32_t)i;
    }
}

static void add_moments(struct moments *sum, const struct sphere_points *points, uint32_t i)
{
    double weight = (double)points->weight[i];
    double x = (double)points->x[i], y = (double)points->y[i], z = (double)points->z[i];
    double wx = weight * x, wy = weight * y, wz = weight * z;
    sum->weight += weight;
    sum->mean[0] += wx;
    sum->mean[1] += wy;
    sum->mean[2] += wz;
    sum->xx += wx * x;
    sum->yy += wy * y;
    sum->zz += wz * z;
    sum->xy += wx * y;
    sum->xz += wx * z;
    sum->yz += wy * z;
}

static double squared_length(const double v[3])
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

static double variance_of(const struct moments *m)
{
    return fmax(m->xx + m->yy + m->zz - squared_length(m->mean) / m->weight, 0);
}

static void multiply(double a[3][3])
{
    double product[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            product[i][j] = a[i][0] * a[0][j] + a[i][1] * a[1][j] + a[i][2] * a[2][j];
    memcpy(a, product, sizeof product);
}

/* The direction of largest variance, by power iteration: repeated squaring of the covariance matrix turns its
 * columns into that direction. If several directions tie, any of them is returned. */
static void find_axis(const struct moments *m, double axis[3])
{
    const double w = m->weight, *s = m->mean;
    double a[3][3] = {{m->xx - s[0] * s[0] / w, m->xy - s[0] * s[1] / w, m->xz - s[0] * s[2] / w},
                      {m->xy - s[0] * s[1] / w, m->yy - s[1] * s[1] / w, m->yz - s[1] * s[2] / w},
                      {m->xz - s[0] * s[2] / w, m->yz - s[1] * s[2] / w, m->zz - s[2] * s[2] / w}};
    for (int round = 0; round < 6; round++) {
        double trace = a[0][0] + a[1][1] + a[2][2];
        for (int i = 0; i < 9; i++)
            a[i / 3][i % 3] /= trace > 0 ? trace : 1;
        multiply(a);
    }
    int longest = 0;
    for (int i = 1; i < 3; i++)
        if (squared_length(a[i]) > squared_length(a[longest]))
            longest = i;
    double length = sqrt(squared_length(a[longest]));
    for (int i = 0; i < 3; i++)
        axis[i] = length > 0 ? a[longest][i] / length : i == 0;
}

/* Projects the points of a node on the axis. Returns their range. */
static void project(const struct sphere_points *points, uint32_t first, uint32_t last, const double axis[3],
                    float *along, float range[2])
{
    float ax = (float)axis[0], ay = (float)axis[1], az = (float)axis[2];
    float low = FLT_MAX, high = -FLT_MAX;
    for (uint32_t i = first; i < last; i++) {
        along[i] = ax * points->x[i] + ay * points->y[i] + az * points->z[i];
        low = along[i] < low ? along[i] : low;
        high = along[i] > high ? along[i] : high;
    }
    range[0] = low;
    range[1] = high;
}

static int bin_of(float along, float low, float scale)
{
    int bin = (int)((along - low) * scale);
    return bin < BINS - 1 ? bin : BINS - 1;
}

/* The bin before which a cut leaves the least variance. The total is fixed, so this is where the sum of |sum
 * w d|^2 / sum w over both sides is largest. The first and the last bin are never empty. */
static int find_cut(const struct sphere_points *points, uint32_t first, uint32_t last, const float *along,
                    float low, float scale)
{
    double bins[BINS][4] = {{0}};
    double total[4] = {0}, before[4] = {0};
    for (uint32_t i = first; i < last; i++) {
        double *bin = bins[bin_of(along[i], low, scale)], weight = (double)points->weight[i];
        bin[0] += weight * (double)points->x[i];
        bin[1] += weight * (double)points->y[i];
        bin[2] += weight * (double)points->z[i];
        bin[3] += weight;
    }
    for (int i = 0; i < BINS; i++)
        for (int c = 0; c < 4; c++)
            total[c] += bins[i][c];
    int best = 1;
    double maximum = -1;
    for (int i = 1; i < BINS; i++) {
        double after[4];
        for (int c = 0; c < 4; c++) {
            before[c] += bins[i - 1][c];
            after[c] = total[c] - before[c];
        }
        double gain = squared_length(before) / before[3] + squared_length(after) / after[3];
        if (gain > maximum)
            best = i, maximum = gain;
    }
    return best;
}

static void move_point(const struct sphere_points *from, uint32_t i, struct sphere_points *to, uint32_t place)
{
    to->x[place] = from->x[i];
    to->y[place] = from->y[i];
    to->z[place] = from->z[i];
    to->weight[place] = from->weight[i];
    to->texel[place] = from->texel[i];
}

/* Partitions the points of `node` into those of its two children, in place; both keep their order. */
static void cut_node(struct tree *tree, const struct growth *node, struct growth children[2])
{
    struct sphere_points *points = &tree->points, *spare = &tree->spare;
    double axis[3];
    float range[2];
    find_axis(&node->moments, axis);
    project(points, node->first, node->last, axis, tree->along, range);
    float scale = BINS / (range[1] - range[0]);
    bool flat = !isfinite(scale); /* the axis does not separate the points: split in the middle */
    int cut = flat ? 0 : find_cut(points, node->first, node->last, tree->along, range[0], scale);
    uint32_t middle = node->first + (node->last - node->first) / 2;
    uint32_t left = node->first, right = left; /* write positions in `points` and in `spare` */
    for (uint32_t i = node->first; i < node->last; i++) {
        bool before = flat ? i < middle : bin_of(tree->along[i], range[0], scale) < cut;
        add_moments(&children[!before].moments, points, i);
        if (before)
            move_point(points, i, points, left++);
        else
            move_point(points, i, spare, right++);
    }
    children[0].first = node->first;
    children[0].last = children[1].first = left;
    children[1].last = node->last;
    for (uint32_t i = node->first; i < right; i++)
        move_point(spare, i, points, left++);
    for (int i = 0; i < 2; i++)
        children[i].variance = fmin(variance_of(&children[i].moments), node->variance);
}

struct rank {
    double variance;
    int node;
};

static int compare_ranks(const void *a, const void *b)
{
    const struct rank *first = a, *second = b;
    if (first->variance != second->variance)
        return first->variance > second->variance ? -1 : 1;
    return first->node < second->node ? -1 : 1;
}

/* Ranks all nodes that can be cut, by decreasing variance. No child has a larger variance than its parent, so
 * no child precedes it. */
static void rank_nodes(struct tree *tree)
{
    struct rank *ranks = TL_NEW_ARRAY(struct rank, (size_t)tree->count);
    size_t count = 0;
    for (int i = 0; i < tree->count; i++) {
        tree->nodes[i].rank = -1;
        if (tree->nodes[i].last - tree->nodes[i].first > 1)
            ranks[count++] = (struct rank){tree->nodes[i].variance, i};
    }
    qsort(ranks, count, sizeof *ranks, compare_ranks);
    for (size_t i = 0; i < count; i++)
        tree->nodes[ranks[i].node].rank = (int)i;
    free(ranks);
}

static bool is_cut(int rank, int count)
{
    return rank >= 0 && rank < count - 1;
}

static int add_child(struct tree *tree, int parent)
{
    if (tree->count == tree->capacity) {
        tree->capacity *= 2;
        tree->nodes = tl_resize(tree->nodes, (size_t)tree->capacity, sizeof *tree->nodes);
    }
    tree->nodes[tree->count] = (struct growth){.parent = parent, .children = {-1, -1}};
    return tree->count++;
}

/* Grows the tree depth by depth, so that there is work for many threads. At each depth all nodes are cut that
 * rank among the first `count` - 1 so far; nodes that deeper nodes displace later stay unused. */
static void grow(struct tree *tree, int count)
{
    int begin = 0, end = tree->count;
    for (rank_nodes(tree); begin < end; rank_nodes(tree)) {
        for (int i = begin; i < end; i++) {
            if (!is_cut(tree->nodes[i].rank, count))
                continue;
            int child = add_child(tree, i);
            add_child(tree, i);
            tree->nodes[i].children[0] = child;
            tree->nodes[i].children[1] = child + 1;
        }
#pragma omp parallel for schedule(dynamic) if (tree->nodes[0].last >= TL_REGIONS_PARALLEL_TEXELS)
        for (int i = begin; i < end; i++)
            if (tree->nodes[i].children[0] >= 0)
                cut_node(tree, &tree->nodes[i], &tree->nodes[tree->nodes[i].children[0]]);
        begin = end;
        end = tree->count;
    }
}

static void tree_create(struct tree *tree, const struct tl_regions *regions)
{
    size_t count = 6 * (size_t)regions->size * (size_t)regions->size;
    *tree = (struct tree){.points = points_create(count),
                          .spare = points_create(count),
                          .along = TL_NEW_ARRAY(float, count),
                          .nodes = TL_NEW_ARRAY(struct growth, 64),
                          .count = 1,
                          .capacity = 64};
    fill_points(regions, &tree->points);
    struct growth *root = &tree->nodes[0];
    *root = (struct growth){.last = (uint32_t)count, .parent = -1, .children = {-1, -1}};
    for (uint32_t i = 0; i < count; i++)
        add_moments(&root->moments, &tree->points, i);
    root->variance = variance_of(&root->moments);
}

static void tree_release(struct tree *tree)
{
    points_release(&tree->points);
    points_release(&tree->spare);
    free(tree->along);
    free(tree->nodes);
}

/* Numbers the regions from left to right, so that merged regions are neighbours. */
static void number_leaves(struct tl_regions *regions, int node)
{
    struct tl_region_node *item = &regions->nodes[node];
    if (item->children[0] < 0) {
        item->region = regions->count++;
        return;
    }
    number_leaves(regions, item->children[0]);
    number_leaves(regions, item->children[1]);
}

/* Copies the nodes of the cut into `count` regions in their order. `region_of` is the region of each node of
 * `from` at or below a leaf, and -1 for the nodes above. */
static void keep_nodes(const struct tl_region_node *from, int from_count, int count, struct tl_regions *out,
                       int *region_of)
{
    int *kept = TL_NEW_ARRAY(int, (size_t)from_count);
    for (int i = 0; i < from_count; i++) {
        int parent = from[i].parent;
        kept[i] = -1;
        if (parent >= 0 && !(kept[parent] >= 0 && is_cut(from[parent].rank, count)))
            continue;
        struct tl_region_node *node = &out->nodes[out->node_count];
        *node = (struct tl_region_node){
            .children = {-1, -1}, .parent = parent < 0 ? -1 : kept[parent], .region = -1, .rank = -1};
        if (is_cut(from[i].rank, count))
            node->rank = from[i].rank;
        if (parent >= 0)
            out->nodes[node->parent].children[from[parent].children[1] == i] = out->node_count;
        kept[i] = out->node_count++;
    }
    number_leaves(out, 0);
    for (int i = 0; i < from_count; i++) /* parents precede their children */
        region_of[i] = kept[i] >= 0 ? out->nodes[kept[i]].region : region_of[from[i].parent];
    free(kept);
}

static void label_points(const struct tree *tree, int count, struct tl_regions *out)
{
    struct tl_region_node *nodes = TL_NEW_ARRAY(struct tl_region_node, (size_t)tree->count);
    int *region_of = TL_NEW_ARRAY(int, (size_t)tree->count);
    for (int i = 0; i < tree->count; i++) {
        const struct growth *node = &tree->nodes[i];
        nodes[i] = (struct tl_region_node){
            .children = {node->children[0], node->children[1]}, .parent = node->parent, .rank = node->rank};
    }
    keep_nodes(nodes, tree->count, count, out, region_of);
    for (int i = 0; i < tree->count; i++)
        if (region_of[i] >= 0)
            for (uint32_t k = tree->nodes[i].first; k < tree->nodes[i].last; k++)
                out->labels[tree->points.texel[k]] = (uint16_t)region_of[i];
    free(nodes);
    free(region_of);
}

void tl_regions_cut_sphere(const tl_cube *cube, int count, struct tl_regions *out)
{
    assert(count >= 1 && count <= TL_REGIONS_MAX);
    struct tree tree;
    tl_regions_begin(cube, out);
    tree_create(&tree, out);
    grow(&tree, count);
    label_points(&tree, count, out);
    tree_release(&tree);
    tl_regions_order(out);
    tl_regions_measure(out);
    tl_regions_weigh(out);
    tl_regions_colour(cube, out);
}
