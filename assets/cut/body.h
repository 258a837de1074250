/* A body that a garment is drafted for: its measures, and its sections to hang the pieces around.
 *
 * The body stands on y = 0 in its rest pose, is upright, faces +Z, is symmetric in x = 0 and holds its arms,
 * if it has any, downwards and away from its sides. Metres. Threads: pure. */
#ifndef TOILE_ASSETS_CUT_BODY_H
#define TOILE_ASSETS_CUT_BODY_H

#include "assets/base/mesh.h"
#include "assets/cut/wrap.h"
#include "config/error.h"

#include <stdbool.h>

/* Signed distance of a point to a body's surface, negative inside, right near the surface. */
struct tl_body_distance {
    double (*at)(const void *context, const double point[3]);
    const void *context;
};

struct tl_body {
    const tl_mesh *mesh; /* borrowed */
    struct tl_body_distance distance;
    double height;
    double waist_y, waist; /* assets/cut/fit.h */
    double hip_y, hip;     /* the widest between waist and crotch */
    double crotch_y;       /* where the legs part */
    double knee, calf;     /* girths: at half the crotch's height and a little above, and the widest below */
};

/* `name` is for messages. Errors: TL_INPUT when a landmark is not found. */
bool tl_body_measure(const char *name, const tl_mesh *mesh, struct tl_body_distance distance,
                     struct tl_body *out, tl_error *error);

/* Girths of the trunk's hull and of the left leg's (on +X); 0 where there is none. */
double tl_body_trunk_girth(const struct tl_body *body, double y);
double tl_body_leg_girth(const struct tl_body *body, double y);

/* Length of a tape that runs from the front at the height y under the crotch to the back at that height. */
double tl_body_crotch_length(const struct tl_body *body, double y);

/* Rings around the trunk and the leg on +X, of the given length, or `length` 0: of the girth. False where
 * there is neither. */
bool tl_body_trunk_ring(const struct tl_body *body, double y, double length, struct tl_ring *out);
bool tl_body_leg_ring(const struct tl_body *body, double y, double length, struct tl_ring *out);

#endif
