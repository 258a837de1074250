/* The openings of a garment: the boundary loops of its welded mesh, with a tailor's names where these are
 * sure.
 *
 * A garment stands upright, faces +Z and is roughly symmetric; its wearer's left is +X. Names are given in
 * each connected piece.
 *
 * - The only loop around the middle that opens upwards is the neck where there are arms. Else it is the waist
 *   where legs are below it or nothing there is narrower, and the top where something is.
 * - The only loop around the middle that opens downwards is the hem.
 * - A pair at the sides is the left and the right cuff, the ends of sleeves; or the left and the right
 * armhole, if it is near the neck and does not open downwards.
 * - A pair at the bottom that opens downwards is the left and the right leg hem.
 *
 * A piece with one loop only is a sheet, and its loop an outline. All others are opening 1, 2, ...
 *
 * Metres, world axes with y up. Lifetime: plain structs that own their arrays. Threads: pure. */
#ifndef TOILE_ASSETS_SEWING_OPENINGS_H
#define TOILE_ASSETS_SEWING_OPENINGS_H

#include <cglm/struct.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Welded: borrowed. */
struct tl_opening_mesh {
    size_t vertex_count, triangle_count;
    const vec3s *positions;
    const uint32_t (*triangles)[3]; /* three different corners each */
};

#define TL_OPENING_NAME 32
struct tl_opening {
    char name[TL_OPENING_NAME]; /* no two alike: the second hem is "hem 2" */
    size_t side_count;
    uint32_t *vertices;  /* [side_count] in order, the opening to their left as seen from outside */
    uint32_t *triangles; /* [side_count] the only one at the side from vertex i to the next */
    double length;       /* of the loop */
    vec3s centre;        /* of the loop, as a wire */
    vec3s normal;        /* unit: that of the area it spans (Newell), out of the garment */
};

struct tl_openings {
    size_t count;
    struct tl_opening *items; /* from the top down; of a pair the left one first */
};

/* False when the mesh does not fit into memory; `out` is then empty. */
bool tl_openings_find(const struct tl_opening_mesh *mesh, struct tl_openings *out);
void tl_openings_release(struct tl_openings *openings);

/* The opening of a name; NULL: there is none. */
const struct tl_opening *tl_openings_named(const struct tl_openings *openings, const char *name);

/* Length of the loop where the vertices are at `positions`. */
double tl_opening_length(const struct tl_opening *opening, const vec3s *positions);

#endif
