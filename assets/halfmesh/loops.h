/* Boundary loops of a welded triangle mesh, by OpenMesh's half-edges.
 *
 * Any list of triangles is accepted. A face that OpenMesh refuses, because it makes an edge or a vertex that
 * is not manifold, gets vertices of its own there; sides that two or more triangles share are not boundary
 * for that, and loops lead past them. Where loops touch in a vertex they are kept apart.
 *
 * Lifetime: plain structs that own their arrays. Threads: pure. */
#ifndef TOILE_ASSETS_HALFMESH_LOOPS_H
#define TOILE_ASSETS_HALFMESH_LOOPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Borrowed. */
struct tl_loop_source {
    size_t vertex_count, triangle_count;
    const uint32_t (*triangles)[3]; /* three different corners each */
};

/* A side of one triangle and of no other, from `from` to the next side's `from`, against the triangle's
 * winding: seen from outside, the opening is to the left. */
struct tl_loop_side {
    uint32_t from, triangle;
};

struct tl_loops {
    size_t count;
    size_t *first;              /* [count + 1]: loop i has sides first[i] to first[i + 1] - 1 */
    struct tl_loop_side *sides; /* no loop has a vertex twice */
    size_t refused;             /* faces that got vertices of their own */
};

/* False when it does not fit into memory; `out` is then empty. */
bool tl_loops_find(const struct tl_loop_source *source, struct tl_loops *out);
void tl_loops_release(struct tl_loops *loops);

#ifdef __cplusplus
}
#endif

#endif
