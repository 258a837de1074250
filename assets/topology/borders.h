/* Border coordinates of a garment's pieces: for every triangle the straight borders that can be the nearest
 * one to a point of it, from which the distance to the nearest border and the length along it follow exactly
 * (render/construction evaluates them for each pixel).
 *
 * A piece is an island of the UV map: triangles that share sides with equal UV at both ends. A border is a
 * side that a piece does not share. Where welding joins it to another border it is a seam, elsewhere a hem.
 * The lists are found by spreading each border from its own triangle to the neighbours: the cell of a nearest
 * border is connected, because the shortest way to a border crosses no other. So a border on the far side of
 * a notch is not found across it.
 *
 * Lifetime: plain struct that owns its arrays; immutable once made. Threads: pure. */
#ifndef TOILE_ASSETS_TOPOLOGY_BORDERS_H
#define TOILE_ASSETS_TOPOLOGY_BORDERS_H

#include "assets/base/garment.h"

/* Borders farther away than this are not listed, metres: wider than any hem. */
#define TL_BORDER_REACH_M 0.032f
/* Pieces of a smaller area have no borders, square metres: buttons, eyelets, tabs. */
#define TL_BORDER_MIN_PIECE_M2 0.0015
/* Cloth that is turned over at a curved border is longer or shorter there than where it lies; this much of it
 * can be eased away by pressing, and with it follows how wide a hem may be. */
#define TL_BORDER_EASE 0.06f

/* One of the two borders of a seam is on the side to which the allowance is pressed. The legs of a dart,
 * which meet at its tip, have no allowance of an even width. */
enum tl_border_kind {
    TL_BORDER_SEAM_OVER,
    TL_BORDER_SEAM_UNDER,
    TL_BORDER_HEM,
    TL_BORDER_DART,
    TL_BORDER_KINDS
};

/* A straight border: one side of a triangle. Eight floats, as the GPU reads them. */
struct tl_border {
    float from[2], to[2]; /* UV; the piece lies on the side of its triangle's third corner */
    float start_m;        /* length along the border at `from` */
    float metres;         /* per UV unit: root of the ratio of the piece's areas in space and in UV */
    float widest_m;       /* hems: the widest that the curvature of their opening allows; else 0 */
    float kind;           /* enum tl_border_kind */
};

typedef struct tl_borders { /* tl_surface knows it by its tag */
    size_t triangle_count, border_count, piece_count;
    struct tl_border *borders;
    uint32_t *firsts; /* [triangle_count + 1] into `near` */
    uint32_t *near;   /* numbers of borders, rising within a triangle */
    bool is_to_scale; /* nine tenths of the area have one size of UV unit, within a fifth */
} tl_borders;

/* Makes the borders of a mesh at rest. `weld` [vertex_count] numbers places, below vertex_count, equal where
 * vertices are one from the start; `seams` joins further ones. `pattern`: the mesh at rest in metres, from
 * which areas are taken, or NULL: from the positions. A mesh without UV has no borders. */
tl_borders tl_borders_make(const tl_mesh *mesh, const vec2s *pattern, const uint32_t *weld,
                           const struct tl_seam_pair *seams, size_t seam_count);
void tl_borders_release(tl_borders *borders); /* frees and zeroes */
size_t tl_borders_bytes(const tl_borders *borders);

#endif
