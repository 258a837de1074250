/* A garment: the mesh to draw, its flat pattern at rest, its seams and its pins.
 *
 * Physics vertices are not listed: cloth welds render vertices of bitwise equal start position, and those
 * that seams join. Immutable once made. */
#ifndef TOILE_ASSETS_BASE_GARMENT_H
#define TOILE_ASSETS_BASE_GARMENT_H

#include "assets/base/model.h"

struct tl_seam_pair {
    uint32_t a, b;
}; /* render vertices that sewing pulls together and then welds */

/* A vertex that is drawn to the plane where its coordinate `axis` is `level_m`: one of height (axis 1) for
 * the first half second of hanging, the others while panels are sewn. Nothing holds it afterwards. */
struct tl_hold {
    uint32_t vertex; /* render */
    int axis, side;  /* side 1 or -1: only from below or from above the level; 0: from both */
    float level_m;
};

/* The rest shape of a garment from a file (assets/sewing/rest.h). */
enum tl_rest_choice { TL_REST_AUTO, TL_REST_UV, TL_REST_MESH };
extern const char *const tl_rest_names[]; /* "auto", "uv", "mesh"; NULL-terminated */

typedef struct tl_garment {
    tl_model model; /* mesh.positions is where the cloth starts */
    /* Rest shape as flat cloth, metres: x along the weft, y along the warp, one per render vertex; NULL when
     * the file has no pattern: then each triangle's start shape is its rest shape and UV directions give warp
     * and weft. */
    vec2s *pattern;
    bool *modelled; /* [triangle] has no pattern of its own, as without one; NULL: none with a pattern */
    size_t seam_count;
    struct tl_seam_pair *seams;
    bool
        welds_seams_only; /* what starts at one place is not one for that: panels that hang over each other */
    size_t pin_count;
    uint32_t *pins; /* render vertices held where they start (on the avatar, they follow its nearest point) */
    size_t hold_count;
    struct tl_hold *holds;
    bool solid; /* rigid, not cloth (assets/specimen/specimen.h) */
} tl_garment;

/* Replaces the garment's pins by the vertices that its model's file pins; a file without pins changes
 * nothing.
 *
 * Errors: none. Lifetime: the garment owns the list. Threads: one per garment. */
void tl_garment_take_pins(tl_garment *garment);

/* Frees what the garment owns and zeroes it; a zeroed garment is accepted.
 *
 * Errors: none. Lifetime: pointers into the garment end here. Threads: one, while no other uses it. */
void tl_garment_release(tl_garment *garment);

#endif
