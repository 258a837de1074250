/* Surfaces around the dress form, or a body, that are nearly developable, for placing the flat pieces of
 * built-in garments with little strain: rings by arc length, and flares that hang from a ring. Metres.
 * Threads: pure.
 */
#ifndef TOILE_ASSETS_BODY_WRAP_H
#define TOILE_ASSETS_BODY_WRAP_H

#include "assets/sewing/panel.h"

#include <stdbool.h>

enum { TL_RING_STEPS = 256, TL_FLARE_STEPS = 512, TL_FLARE_ROWS = 33 };

/* A closed convex curve around the form, or a limb, at one height: the section's hull, moved outwards. */
struct tl_ring {
    double y, length;
    struct tl_point points[TL_RING_STEPS + 1]; /* (x, z) at equal distances, from the front over +X */
};

/* `length` must exceed the form's girth at that height. */
void tl_ring_around_form(double y, double length, struct tl_ring *out);

/* Around `section` [count], points (x, z) whose hull is `girth` long. `symmetric`: in x = 0. Where `length`
 * is less than the girth, the ring is inside. */
void tl_ring_around(const struct tl_point *section, int count, double girth, bool symmetric, double length,
                    struct tl_ring *out);

/* At `distance` along the ring from the front's middle, positive towards +X, periodic. */
struct tl_point tl_ring_at(const struct tl_ring *ring, double distance);

/* A sector of a ring-shaped skirt hung from a ring: a cone of the given slope, its surplus width laid in even
 * folds, so that every circle of the pattern keeps its length. */
struct tl_flare {
    double length;                                             /* from the ring down, metres of cloth */
    double y[TL_FLARE_ROWS];                                   /* height of each row */
    struct tl_point points[TL_FLARE_ROWS][TL_FLARE_STEPS + 1]; /* (x, z) at equal fractions of a row */
};

/* `full_angle`: of the whole skirt's sector, radians (2 pi: a full circle skirt); `slope`: of the cone from
 * the vertical, radians; `folds`: how many. */
void tl_flare_from_ring(const struct tl_ring *ring, double length, double full_angle, double slope, int folds,
                        struct tl_flare *out);

/* At `fraction` of a turn from the front's middle towards +X, and `down` metres of cloth below the ring. */
void tl_flare_at(const struct tl_flare *flare, double fraction, double down, double position[3]);

#endif
