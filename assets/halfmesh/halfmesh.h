/* Cages: coarser versions of a welded triangle mesh, made by OpenMesh's decimation.
 *
 * Vertices are removed by edge collapses, best first, until few enough are left; those that stay keep their
 * places. Triangles get the flat rest shapes that the cloth has between their corners (sector.h), so that a
 * cage is as wide and as long as the cloth, also where its corners cut across folds. Seams and borders
 * collapse along themselves only, and keep their bends; separate layers stay separate. Held vertices are
 * removed only in favour of held ones. Any list of triangles is accepted: a face that OpenMesh refuses,
 * because it makes an edge or a vertex that is not manifold, gets vertices of its own there, and its corners
 * stay.
 *
 * Lengths in metres. Lifetime: plain structs that own their arrays. Threads: pure. */
#ifndef TOILE_ASSETS_HALFMESH_HALFMESH_H
#define TOILE_ASSETS_HALFMESH_HALFMESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* All borrowed. */
struct tl_cage_source {
    size_t vertex_count, triangle_count;
    const uint32_t (*triangles)[3]; /* three different corners each */
    const float (*rest)[3][2];      /* [triangle] its flat rest shape, x along the weft */
    const bool (*seams)[3];         /* [triangle] whether the edge that faces each corner is a seam */
    const bool *held;               /* [vertex_count] */
};

/* The place of a vertex of the source on a cage: the weights of the corners of a triangle, whose sum is 1. At
 * a border that was straightened one may be negative. */
struct tl_cage_point {
    uint32_t triangle;
    double weights[3];
};

struct tl_cage {
    size_t vertex_count, triangle_count;
    uint32_t *vertices;           /* [vertex_count] of the source, rising */
    uint32_t (*triangles)[3];     /* [triangle_count] numbers in `vertices` */
    float (*rest)[3][2];          /* [triangle_count] */
    struct tl_cage_point *points; /* [source's vertex_count]; of a vertex without triangles: triangle
                                     UINT32_MAX */
    size_t refused;               /* faces that got vertices of their own */
};

/* Makes the cage with `vertex_target` vertices, or somewhat more where no further vertex may be removed.
 * False when it does not fit into memory; `out` is then empty. */
bool tl_cage_make(const struct tl_cage_source *source, size_t vertex_target, struct tl_cage *out);
void tl_cage_release(struct tl_cage *cage);

#ifdef __cplusplus
}
#endif

#endif
