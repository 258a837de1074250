/* Maps the vertices of a fine mesh to the vertices of a coarse one on which it lies, so that each triangle
 * becomes a triangle, a side or a corner of the coarse mesh: a simplicial approximation of the fine mesh's
 * place on it [Hatcher 2002, theorem 2C.1]. With its vertices there the fine mesh
 * covers parts of the coarse mesh and nothing else, so it crosses itself only where the coarse mesh does.
 *
 * A vertex becomes the corner that has its largest share. Where the fine triangles are not small against the
 * coarse ones, some are not mapped to one triangle by that; their vertices are then mapped to other bones
 * near them in sweeps, which end when all are, or after 100.
 *
 * Threads: pure. */
#ifndef TOILE_CLOTH_CAGE_SIMPLICIAL_H
#define TOILE_CLOTH_CAGE_SIMPLICIAL_H

#include "cloth/cage/skin.h"

struct tl_coarse_mesh {
    const uint32_t (*triangles)[3]; /* with bones as corners */
    const struct tl_fans *fans;     /* corners of its triangles around each bone */
};

/* Writes the bone of each vertex of the source's topology; TL_NONE: it has no place. Returns the number of
 * triangles that are still not mapped to one triangle: 0 of a dress of 121,000 vertices on 3,000, 0.03 % of
 * one of 7,500. */
size_t tl_simplicial_map(const struct tl_skin_source *source, const struct tl_coarse_mesh *coarse,
                         uint32_t *out);

#endif
