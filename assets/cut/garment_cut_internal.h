/* Descriptions and cuts of built-in garments: flat pieces, the start position of each around the dress form,
 * their seams and their pins. One plan per garment (garment_cut_dress.c,
 * garment_cut_skirt.c); garment_cut.c turns a plan into a tl_garment.
 *
 * A piece is symmetric about x = 0: `half` runs counter-clockwise along its right side from the bottom's
 * middle to the top's middle. In the whole outline, curve i < half_count is half[i] and curve
 * 2 half_count - 1 - i is its mirror image. Or it is `whole`: then `half` is all of its outline, and
 * tl_cut_mirrored makes its counterpart. Metres; x along the weft, y along the warp. */
#ifndef TOILE_ASSETS_CUT_GARMENT_CUT_INTERNAL_H
#define TOILE_ASSETS_CUT_GARMENT_CUT_INTERNAL_H

#include "assets/body/body.h"
#include "assets/body/wrap.h"
#include "assets/cut/garment_cut.h"
#include "assets/sewing/panel.h"

#include <stdbool.h>

enum { TL_CUT_MAX_HALF = 12, TL_CUT_MAX_PIECES = 12, TL_CUT_MAX_SEAMS = 48, TL_CUT_MAX_PINS = 4 };

struct tl_cut_piece {
    struct tl_curve half[TL_CUT_MAX_HALF];
    size_t half_count;
    bool whole;
    struct tl_point table_offset; /* where the piece lies on the cutting table: pieces do not overlap */
    void (*place)(const void *context, struct tl_point pattern, double position[3]);
    const void *context;
    const char *material; /* its name; pieces of one material follow one another */
};

/* Curves that are sewn: they run in opposite directions, as neighbours in counter-clockwise outlines do. */
struct tl_cut_seam {
    size_t piece_a, curve_a, piece_b, curve_b;
};

struct tl_cut_pin {
    size_t piece, curve;
};

struct tl_cut_plan {
    const char *name;
    struct tl_cut_piece pieces[TL_CUT_MAX_PIECES];
    size_t piece_count;
    struct tl_cut_seam seams[TL_CUT_MAX_SEAMS];
    size_t seam_count;
    struct tl_cut_pin pins[TL_CUT_MAX_PINS];
    size_t pin_count;
    void *placement;                  /* owned: what the pieces' contexts point into; free() releases it */
    struct tl_body_distance distance; /* of the body */
    bool keeps_sides;                 /* its left and its right do not pass x = 0 */
};

/* A piece of a flared skirt: half of a sector of a ring, hung around the form. Its curves: 0 hem, 1 side, 2
 * waist. The pattern's circles are centred at (0, 0), the cloth hangs to -y. */
struct tl_cut_flared {
    const struct tl_flare *flare;
    double waist_length, full_angle; /* of the whole skirt: metres, radians */
    double turn;                     /* where the piece's middle hangs: front 0, back 1/2 of a turn */
};
struct tl_cut_piece tl_cut_flared_piece(const struct tl_cut_flared *flared);

/* The additional length that a garment can have, metres; most of them are bounded on one side only. */
struct tl_cut_range {
    double minimum, maximum;
};

struct tl_cut_plan tl_cut_plan_dress(const struct tl_cut_params *sizes);
struct tl_cut_plan tl_cut_plan_skirt(const struct tl_cut_params *sizes);
struct tl_cut_plan tl_cut_plan_layers(const struct tl_cut_params *sizes);

/* Skirts are no shorter. */
#define TL_CUT_SHORTEST_SKIRT_M 0.1
struct tl_cut_range tl_cut_longer_dress(void);
struct tl_cut_range tl_cut_longer_skirt(void);

/* Trousers end above the feet and below the fork, shirts below the waist; sleeves leave room for a cuff. */
struct tl_cut_range tl_cut_longer_trousers(const struct tl_body *body);
struct tl_cut_range tl_cut_longer_shirt(const struct tl_body *body);
struct tl_cut_range tl_cut_longer_sleeves(const struct tl_body *body);

/* Drafted for a body; `body` must live as long as the plan, and the sizes lie within the ranges above. */
struct tl_cut_plan tl_cut_plan_trousers(const struct tl_body *body, const struct tl_cut_params *sizes);
/* The body has arms. */
struct tl_cut_plan tl_cut_plan_shirt(const struct tl_body *body, const struct tl_cut_params *sizes);

/* The mirror image in x = 0, run through backwards: counter-clockwise again. */
struct tl_curve tl_cut_mirrored_curve(const struct tl_curve *curve);

/* The counterpart of a whole piece: curve i of the one is curve half_count - 1 - i of the other. Places and
 * contexts are the caller's to set. */
struct tl_cut_piece tl_cut_mirrored(const struct tl_cut_piece *piece);

/* Adds one seam. */
void tl_cut_sew(struct tl_cut_plan *plan, size_t piece_a, size_t curve_a, size_t piece_b, size_t curve_b);

/* The index of half[i]'s mirror image in the whole outline. */
static inline size_t tl_cut_mirror(const struct tl_cut_piece *piece, size_t i)
{
    return 2 * piece->half_count - 1 - i;
}

/* Relaxes a start shape: moves edges towards their rest lengths and vertices out of the body; `fixed`
 * ones stay. It is no simulation (no mass, no gravity) but removes the strain of the first guess. `reach_m`:
 * how far corrections travel, at one edge a pass; at least a hundred passes are made. `keeps_sides`: what
 * starts left or right of x = 0 stays a millimetre off it. */
struct tl_fit_edge {
    uint32_t a, b;
    double length; /* metres, at rest */
};
void tl_cut_fit(double (*positions)[3], size_t count, const bool *fixed, const struct tl_fit_edge *edges,
                size_t edge_count, double reach_m, struct tl_body_distance distance, bool keeps_sides);

/* Interpolates positions [vertices of `garment`], metres, from a coarser cut of the same plan with edges of
 * about edge_m, by the place of each vertex in the flat pattern: linearly over triangles, extrapolated a
 * little past the outline. Pins, and vertices farther outside, stay. */
void tl_cut_carry(const tl_garment *coarse, double edge_m, const tl_garment *garment, double (*positions)[3]);

#endif
