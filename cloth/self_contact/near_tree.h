/* A tree of boxes over the cloth's own triangles, which finds the pairs of triangles whose boxes overlap.
 *
 * Leaves hold up to TL_NEAR_LEAF triangles that lie near one another when the tree is built; later positions
 * only refit the boxes. The tree is complete, so that both nodes of a pair are always on one level. Boxes are
 * single precision, rounded outwards, about an origin near the cloth. The traversal is divided into tasks
 * that depend on the tree's shape only: pairs in the order of the tasks are the same at any number of
 * threads. Metres. Errors: none. Lifetime: plain structs that own their arrays. Threads: tasks of one tree
 * may run at the same time. */
#ifndef TOILE_CLOTH_SELF_CONTACT_NEAR_TREE_H
#define TOILE_CLOTH_SELF_CONTACT_NEAR_TREE_H

#include "cloth/mesh/topology.h"
#include "cloth/mesh/vec3d.h"

#include <stdbool.h>

#define TL_NEAR_LEAF 8
/* Cloth with fewer vertices is searched by one thread: a refit of 2,000 takes 0.1 ms. */
#define TL_NEAR_PARALLEL_VERTICES 2000

struct tl_near_box {
    float low[3], high[3];
};

/* The boxes of a leaf's triangles, coordinate by coordinate. Empty lanes have low > high and overlap nothing.
 */
struct tl_near_leaf {
    float low[3][TL_NEAR_LEAF], high[3][TL_NEAR_LEAF];
    uint32_t triangles[TL_NEAR_LEAF]; /* TL_NONE in empty lanes */
    uint32_t open[3][TL_NEAR_LEAF];   /* corners of the triangles; TL_NONE: not open */
};

struct tl_near_tree {
    size_t leaf_count; /* a power of two */
    struct tl_near_leaf *leaves;
    struct tl_near_box
        *nodes; /* [2 leaf_count] 1: the root; 2i and 2i + 1: children of i; leaves come last */
    size_t task_count;
    uint32_t (*tasks)[2]; /* [task_count] pairs of nodes of one level */
};

/* Sorts the triangles into leaves by their centres at positions `x`. The boxes are empty until the first
 * refit. */
struct tl_near_tree tl_near_tree_create(const struct tl_topology *topology, const vec3d *x);
void tl_near_tree_release(struct tl_near_tree *tree);

/* Fits the boxes to balls of radius margins[v] (NULL: 0) about the positions x[v] of the triangles' corners.
 * Pairs of triangles that have a corner v in common with open[v] (NULL: none) will not be found. */
void tl_near_tree_refit(struct tl_near_tree *tree, const struct tl_topology *topology, const vec3d *x,
                        const double *margins, const bool *open);

struct tl_near_pairs {
    size_t count, capacity;
    size_t limit;         /* a task ends soon after so many pairs; 0: it finds all */
    bool cut_short;       /* it did end so */
    uint32_t (*pairs)[2]; /* triangles */
};

void tl_near_pairs_append(struct tl_near_pairs *pairs, const struct tl_near_pairs *more);
void tl_near_pairs_release(struct tl_near_pairs *pairs);

/* Replaces `out` by the pairs of different triangles whose boxes overlap, as far as a task finds them; except
 * those that an open corner joins; each pair belongs to one task, once. */
void tl_near_tree_pairs(const struct tl_near_tree *tree, size_t task, struct tl_near_pairs *out);

#endif
