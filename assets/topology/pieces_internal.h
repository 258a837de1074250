/* Pieces of a mesh and their borders in order, before they are listed by triangle. */
#ifndef TOILE_ASSETS_TOPOLOGY_PIECES_INTERNAL_H
#define TOILE_ASSETS_TOPOLOGY_PIECES_INTERNAL_H

#include "assets/topology/borders.h"

#define TL_NO_BORDER UINT32_MAX

/* Sides are numbered 3 t + k: of triangle t, from its corner k to the next. */
struct tl_pieces {
    size_t triangle_count, piece_count;
    uint32_t *places;   /* [vertex_count] welded, seams closed */
    uint32_t *across;   /* [3 triangle_count] the side of the same piece on the other side, or TL_NO_BORDER */
    uint32_t *partners; /* [3 triangle_count] of a border that is a seam: another side there */
    uint32_t *pieces;   /* [triangle_count] */
    float *metres;      /* [piece_count] per UV unit; 0: the piece has no borders */
    double *areas;      /* [piece_count] square metres */
};

struct tl_pieces tl_pieces_find(const tl_mesh *mesh, const vec2s *pattern, const uint32_t *weld,
                                const struct tl_seam_pair *seams, size_t seam_count);
void tl_pieces_release(struct tl_pieces *pieces);

/* The next border around the same piece: from the end of border `side`. */
uint32_t tl_pieces_next(const struct tl_pieces *pieces, uint32_t side);

#endif
