#include "render/trace/tree.h"

#include "config/base/memory.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

#define BINS 32

/* Work in that of a node, of 230 operations: a triangle has 100. One more division of a node costs less than
 * a node, as eight children share one. Counted by hand. */
#define TRIANGLE_WORK 0.4f
#define DIVISION_WORK 0.4f

/* A tree of two children a node becomes one of eight: a level for three. The root has a level of its own. */
#define HEIGHT_MAX (3 * (TL_TREE_LEVELS_MAX - 1))

struct box {
    vec3s low, high;
};

static struct box empty_box(void)
{
    return (struct box){{{FLT_MAX, FLT_MAX, FLT_MAX}}, {{-FLT_MAX, -FLT_MAX, -FLT_MAX}}};
}

static struct box join(struct box a, struct box b)
{
    return (struct box){glms_vec3_minv(a.low, b.low), glms_vec3_maxv(a.high, b.high)};
}

static float area(struct box box)
{
    const vec3s side = glms_vec3_sub(box.high, box.low);
    return side.x < 0 ? 0 : 2 * (side.x * side.y + side.y * side.z + side.z * side.x);
}

static vec3s middle(struct box box)
{
    return glms_vec3_scale(glms_vec3_add(box.low, box.high), 0.5f);
}

static struct box box_of_triangle(const vec3s *positions, const uint32_t corners[3])
{
    struct box box = empty_box();
    for (int k = 0; k < 3; k++) {
        vec3s at = positions[corners[k]];
        for (int axis = 0; axis < 3; axis++)
            at.raw[axis] = isfinite(at.raw[axis]) ? at.raw[axis] : 0;
        box = join(box, (struct box){at, at});
    }
    return box;
}

/* ---- Two children a node ---- */

struct binary_node {
    struct box box;
    int left, right;       /* -1: a leaf */
    int height;            /* 0: a leaf */
    uint32_t first, count; /* of `order` */
};

struct builder {
    struct box *boxes; /* of triangles */
    uint32_t *order;
    struct binary_node *nodes;
    int node_count;
};

struct split {
    int axis, bin; /* bins from this one on are to the right; axis -1: none */
    float low, scale;
    float cost; /* area times triangles, of both sides */
};

static int bin_of(const struct builder *builder, uint32_t place, int axis, float low, float scale)
{
    return (int)((middle(builder->boxes[builder->order[place]]).raw[axis] - low) * scale);
}

/* Finds the best split of an axis, if it is better than what is in `best`. */
static void try_axis(const struct builder *builder, uint32_t first, uint32_t count, int axis,
                     struct box middles, struct split *best)
{
    const float low = middles.low.raw[axis], extent = middles.high.raw[axis] - low;
    if (!(extent > 1e-12f))
        return;
    const float scale = (float)BINS * 0.9999f / extent;
    struct box bins[BINS], sum = empty_box();
    uint32_t counts[BINS] = {0}, left = 0;
    float right_cost[BINS]; /* of the bins from this one on */
    for (int k = 0; k < BINS; k++)
        bins[k] = empty_box();
    for (uint32_t i = first; i < first + count; i++) {
        const int k = bin_of(builder, i, axis, low, scale);
        bins[k] = join(bins[k], builder->boxes[builder->order[i]]);
        counts[k]++;
    }
    for (int k = BINS - 1, right = 0; k > 0; k--) {
        sum = join(sum, bins[k]);
        right += (int)counts[k];
        right_cost[k] = area(sum) * (float)right;
    }
    sum = empty_box();
    for (int k = 1; k < BINS; k++) {
        sum = join(sum, bins[k - 1]);
        left += counts[k - 1];
        const float cost = area(sum) * (float)left + right_cost[k];
        if (left > 0 && left < count && (best->axis < 0 || cost < best->cost))
            *best = (struct split){axis, k, low, scale, cost};
    }
}

/* Moves the triangles of the left side to the front. Returns where the right side begins. */
static uint32_t partition(struct builder *builder, uint32_t first, uint32_t count, const struct split *split)
{
    uint32_t i = first, j = first + count;
    while (i < j) {
        if (bin_of(builder, i, split->axis, split->low, split->scale) < split->bin) {
            i++;
        } else {
            const uint32_t other = builder->order[--j];
            builder->order[j] = builder->order[i];
            builder->order[i] = other;
        }
    }
    return i;
}

static int log2_ceil(uint32_t count)
{
    int bits = 0;
    while (count > 1u << bits)
        bits++;
    return bits;
}

/* Returns where a node is divided; `first`: it stays a leaf. Halves of equal count, where no plane divides
 * the middles and where other splits might leave more levels than there may be. */
static uint32_t divide(struct builder *builder, const struct binary_node *node, int height_max)
{
    struct box middles = empty_box();
    struct split split = {.axis = -1};
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
        const vec3s at = middle(builder->boxes[builder->order[i]]);
        middles = join(middles, (struct box){at, at});
    }
    for (int axis = 0; axis < 3; axis++)
        try_axis(builder, node->first, node->count, axis, middles, &split);
    const float around = area(node->box), as_leaf = TRIANGLE_WORK * around * (float)node->count;
    if (node->count <= TL_TREE_LEAF_MAX &&
        (split.axis < 0 || DIVISION_WORK * around + TRIANGLE_WORK * split.cost >= as_leaf))
        return node->first;
    if (split.axis < 0 || height_max <= log2_ceil(node->count))
        return node->first + node->count / 2;
    return partition(builder, node->first, node->count, &split);
}

static int build_binary(struct builder *builder, uint32_t first, uint32_t count, int height_max)
{
    const int number = builder->node_count++;
    struct binary_node node = {.box = empty_box(), .left = -1, .right = -1, .first = first, .count = count};
    for (uint32_t i = first; i < first + count; i++)
        node.box = join(node.box, builder->boxes[builder->order[i]]);
    const uint32_t at = count > 1 ? divide(builder, &node, height_max) : first;
    if (at > first) {
        node.left = build_binary(builder, first, at - first, height_max - 1);
        node.right = build_binary(builder, at, first + count - at, height_max - 1);
        const int left = builder->nodes[node.left].height, right = builder->nodes[node.right].height;
        node.height = 1 + (left > right ? left : right);
    }
    builder->nodes[number] = node;
    return number;
}

/* ---- Eight children a node ---- */

/* The child to be replaced by its two: the largest; but first those that are too high for the levels below.
 */
static int child_to_open(const struct builder *builder, const int *children, int count, int height_max)
{
    int best = -1;
    float largest = -1;
    for (int k = 0; k < count; k++) {
        const struct binary_node *child = &builder->nodes[children[k]];
        if (child->left < 0)
            continue;
        const float size = child->height > height_max ? FLT_MAX : area(child->box);
        if (size > largest) {
            largest = size;
            best = k;
        }
    }
    return best;
}

/* Up to eight descendants that together are the node. */
static int collect_children(const struct builder *builder, int from, int height_max,
                            int children[TL_TREE_WIDTH])
{
    int count = 1;
    children[0] = from;
    while (count < TL_TREE_WIDTH) {
        const int opened = child_to_open(builder, children, count, height_max);
        if (opened < 0)
            break;
        const struct binary_node *node = &builder->nodes[children[opened]];
        children[opened] = node->left;
        children[count++] = node->right;
    }
    return count;
}

/* Puts children into the slots of the corners that they lie farthest towards, the farthest first. */
static void assign_slots(const struct builder *builder, int from, const int *children, int count,
                         int at_slot[TL_TREE_WIDTH])
{
    const vec3s centre = middle(builder->nodes[from].box);
    int child_of_slot[TL_TREE_WIDTH];
    uint32_t placed = 0;
    for (int s = 0; s < TL_TREE_WIDTH; s++)
        child_of_slot[s] = -1;
    for (int round = 0; round < count; round++) {
        float farthest = -FLT_MAX;
        int best = 0, slot = 0;
        bool is_found = false;
        for (int k = 0; k < count; k++) {
            const vec3s towards = glms_vec3_sub(middle(builder->nodes[children[k]].box), centre);
            for (int s = 0; s < TL_TREE_WIDTH && !(placed >> k & 1); s++) {
                const float far = (s & 1 ? towards.x : -towards.x) + (s & 2 ? towards.y : -towards.y) +
                                  (s & 4 ? towards.z : -towards.z);
                if (child_of_slot[s] < 0 && (!is_found || far > farthest)) {
                    is_found = true;
                    farthest = far;
                    best = k;
                    slot = s;
                }
            }
        }
        placed |= 1u << best;
        child_of_slot[slot] = best;
    }
    for (int s = 0; s < TL_TREE_WIDTH; s++)
        at_slot[s] = child_of_slot[s] < 0 ? -1 : children[child_of_slot[s]];
}

static uint32_t place_leaf(const struct builder *builder, const struct binary_node *leaf, uint32_t *placed,
                           struct tl_tree *out)
{
    const uint32_t word = TL_TREE_LEAF | leaf->count << TL_TREE_COUNT_SHIFT | *placed;
    for (uint32_t i = 0; i < leaf->count; i++)
        out->order[(*placed)++] = builder->order[leaf->first + i];
    return word;
}

/* Makes the root: its children are the trees of the casters and of the others. Returns how many nodes there
 * are. */
static size_t place_root(const int *trees, size_t tree_count, int *queue, struct tl_tree *out)
{
    for (size_t s = 0; s < TL_TREE_WIDTH; s++) {
        out->children[0][s] = s < tree_count ? (uint32_t)(1 + s) : TL_TREE_NO_CHILD;
        if (s < tree_count)
            queue[1 + s] = trees[s];
    }
    out->heads[0][0] = TL_TREE_CASTERS;
    out->level_first[++out->level_count] = TL_TREE_CASTERS;
    return 1 + tree_count;
}

/* Numbers nodes in the order in which they come up, breadth first. `queue`: the binary node of each, but the
 * root's. */
static void collapse(const struct builder *builder, const int *trees, size_t tree_count, int *queue,
                     struct tl_tree *out)
{
    size_t end = place_root(trees, tree_count, queue, out), level_end = end;
    uint32_t placed = 0;
    for (size_t number = TL_TREE_CASTERS; number < end; number++) {
        int children[TL_TREE_WIDTH], at_slot[TL_TREE_WIDTH];
        if (number == level_end) {
            out->level_first[++out->level_count] = (uint32_t)number;
            level_end = end;
        }
        assert(out->level_count < TL_TREE_LEVELS_MAX);
        const int height_max = HEIGHT_MAX - 3 * out->level_count;
        const int count = collect_children(builder, queue[number], height_max, children);
        assign_slots(builder, queue[number], children, count, at_slot);
        out->heads[number][0] = (uint32_t)end;
        out->heads[number][1] = placed;
        for (int s = 0; s < TL_TREE_WIDTH; s++) {
            const struct binary_node *child = at_slot[s] < 0 ? NULL : &builder->nodes[at_slot[s]];
            if (!child || child->count == 0) {
                out->children[number][s] = TL_TREE_NO_CHILD;
            } else if (child->left < 0) {
                out->children[number][s] = place_leaf(builder, child, &placed, out);
            } else {
                queue[end] = at_slot[s];
                out->children[number][s] = (uint32_t)end++;
            }
        }
    }
    out->level_first[++out->level_count] = (uint32_t)end;
    out->node_count = end;
}

struct tl_tree tl_tree_build(const vec3s *positions, const uint32_t *corners, size_t triangle_count,
                             size_t caster_count)
{
    assert(triangle_count <= TL_TREE_PLACE && caster_count <= triangle_count);
    const size_t nodes = triangle_count + 3; /* each inner node parts triangles; a root, and two trees */
    const size_t tree_count = caster_count < triangle_count ? 2 : 1;
    struct tl_tree tree = {.triangle_count = triangle_count,
                           .children = tl_alloc(nodes, sizeof *tree.children),
                           .heads = tl_alloc(nodes, sizeof *tree.heads),
                           .order = TL_NEW_ARRAY(uint32_t, triangle_count)};
    struct builder builder = {.boxes = TL_NEW_ARRAY(struct box, triangle_count),
                              .order = TL_NEW_ARRAY(uint32_t, triangle_count),
                              .nodes = TL_NEW_ARRAY(struct binary_node, 2 * nodes)};
    int *queue = TL_NEW_ARRAY(int, nodes);
    for (size_t t = 0; t < triangle_count; t++) {
        builder.boxes[t] = box_of_triangle(positions, corners + 3 * t);
        builder.order[t] = (uint32_t)t;
    }
    const int casters = build_binary(&builder, 0, (uint32_t)caster_count, HEIGHT_MAX);
    const int others =
        build_binary(&builder, (uint32_t)caster_count, (uint32_t)(triangle_count - caster_count), HEIGHT_MAX);
    collapse(&builder, (int[]){casters, others}, tree_count, queue, &tree);
    free(queue);
    free(builder.boxes);
    free(builder.order);
    free(builder.nodes);
    return tree;
}

void tl_tree_release(struct tl_tree *tree)
{
    free(tree->children);
    free(tree->heads);
    free(tree->order);
    *tree = (struct tl_tree){0};
}

static struct box box_of_leaf(const struct tl_tree *tree, uint32_t child, const vec3s *positions,
                              const uint32_t *corners)
{
    const uint32_t count = (child & ~TL_TREE_LEAF) >> TL_TREE_COUNT_SHIFT, place = child & TL_TREE_PLACE;
    struct box box = empty_box();
    for (uint32_t i = place; i < place + count; i++)
        box = join(box, box_of_triangle(positions, corners + 3 * (size_t)tree->order[i]));
    return box;
}

double tl_tree_cost(const struct tl_tree *tree, const vec3s *positions, const uint32_t *corners)
{
    struct box *boxes = TL_NEW_ARRAY(struct box, tree->node_count);
    double *work = TL_NEW_ARRAY(double, tree->node_count);            /* times area, of all below */
    for (size_t node = tree->node_count; node-- > TL_TREE_CASTERS;) { /* children lie behind their parents */
        boxes[node] = empty_box();
        for (int s = 0; s < TL_TREE_WIDTH; s++) {
            const uint32_t child = tree->children[node][s];
            if (child == TL_TREE_NO_CHILD)
                continue;
            const bool is_leaf = child & TL_TREE_LEAF;
            const struct box box = is_leaf ? box_of_leaf(tree, child, positions, corners) : boxes[child];
            const uint32_t count = (child & ~TL_TREE_LEAF) >> TL_TREE_COUNT_SHIFT;
            work[node] += is_leaf ? (double)(TRIANGLE_WORK * area(box) * (float)count) : work[child];
            boxes[node] = join(boxes[node], box);
        }
        work[node] += (double)area(boxes[node]);
    }
    const double whole = (double)area(boxes[TL_TREE_CASTERS]), all = work[TL_TREE_CASTERS];
    free(boxes);
    free(work);
    return whole > 0 ? all / whole : 1;
}
