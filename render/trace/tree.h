/* A tree of boxes over triangles for rays on the graphics card, eight children a node [Ylitie et al.
 * 2017]. Its topology is made here, on the CPU, once for a mesh; its boxes are fitted to a pose by refit.comp
 * (tree_buffers.h), and trace.glsl follows rays through it. Splits are those of the smallest surface area among
 * bins [Wald 2007].
 *
 * Nodes lie breadth first: level by level, the inner children of a node side by side, and so do the triangles
 * of its leaves. Deterministic. Pure; threads: any. */
#ifndef TOILE_RENDER_TRACE_TREE_H
#define TOILE_RENDER_TRACE_TREE_H

#include <cglm/struct.h>
#include <stddef.h>
#include <stdint.h>

#include "render/trace/tree_terms.glsl"

struct tl_tree {
    size_t node_count, triangle_count;
    uint32_t (*children)[TL_TREE_WIDTH]; /* [node_count] */
    uint32_t (*heads)[2];                /* [node_count]: first inner child, first place of its leaves */
    uint32_t *order;                     /* [triangle_count]: triangle at each place */
    int level_count;
    uint32_t level_first[TL_TREE_LEVELS_MAX + 1]; /* nodes */
};

/* `corners`: three vertices a triangle. Triangles from `caster_count` on cast no shadow, as the ground: rays
 * that begin at node TL_TREE_CASTERS do not meet them. Of vertices that are not finite the place is unknown.
 */
struct tl_tree tl_tree_build(const vec3s *positions, const uint32_t *corners, size_t triangle_count,
                             size_t caster_count);
void tl_tree_release(struct tl_tree *tree);

/* The work of a ray that meets the box of the casters, in nodes, when the tree's boxes are fitted to these
 * positions: the surface area heuristic [Wald 2007, 2]. It grows as the mesh moves away from the pose of the
 * build. */
double tl_tree_cost(const struct tl_tree *tree, const vec3s *positions, const uint32_t *corners);

#endif
