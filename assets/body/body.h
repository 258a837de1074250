/* A body that a garment is drafted for: its measures, and its sections to hang the pieces around.
 *
 * The body stands on y = 0 in its rest pose, is upright, faces +Z, is symmetric in x = 0 and holds its arms,
 * if it has any, downwards and away from its sides. Metres. Threads: pure. */
#ifndef TOILE_ASSETS_BODY_BODY_H
#define TOILE_ASSETS_BODY_BODY_H

#include "assets/base/mesh.h"
#include "assets/body/section.h"
#include "assets/body/wrap.h"
#include "config/base/error.h"

#include <stdbool.h>

/* Signed distance of a point to a body's surface, negative inside, right near the surface. */
struct tl_body_distance {
    double (*at)(const void *context, const double point[3]);
    const void *context;
};

/* The arm on +X, from the armpit's height to the wrist, in equal steps along its middle. */
enum { TL_ARM_STEPS = 33 };
struct tl_body_arm {
    double length;
    vec3s middle[TL_ARM_STEPS];
    vec3s along[TL_ARM_STEPS], ahead[TL_ARM_STEPS], outer[TL_ARM_STEPS]; /* unit: to the hand, forward, up */
};

struct tl_body {
    const tl_mesh *mesh; /* borrowed */
    struct tl_body_distance distance;
    double height;
    double waist_y, waist; /* assets/body/fit.h */
    double hip_y, hip;     /* the widest between waist and crotch */
    double crotch_y;       /* where the legs part */
    double underarm_y;     /* the highest section with arms beside the trunk; 0: no arms hang there */
    double bust;           /* the widest from waist to underarm */
    double neck_y, neck, neck_half, neck_z; /* the narrowest section above the shoulders: half its width, and
                                               its middle's z */
    struct tl_body_arm arm;                 /* where there are arms */
    double knee, calf; /* girths: at half the crotch's height and a little above, and the widest below */
};

/* `name` is for messages. Errors: TL_INPUT when a landmark is not found. */
bool tl_body_measure(const char *name, const tl_mesh *mesh, struct tl_body_distance distance,
                     struct tl_body *out, tl_error *error);

/* Girths of the trunk's hull and of the left leg's (on +X); 0 where there is none. */
double tl_body_trunk_girth(const struct tl_body *body, double y);
double tl_body_leg_girth(const struct tl_body *body, double y);

/* False when the mesh has no arm on +X from that height down. */
bool tl_body_measure_arm(const tl_mesh *mesh, double underarm_y, struct tl_body_arm *out);

/* Girth of the arm across a step, 0 where there is none; with `ring`, a ring of the given length around it,
 * in (ahead, outer) from the middle. */
double tl_body_arm_girth(const tl_mesh *mesh, const struct tl_body_arm *arm, size_t step, double length,
                         struct tl_ring *ring);

/* Length of a tape that runs from the front at the height y under the crotch to the back at that height. */
double tl_body_crotch_length(const struct tl_body *body, double y);

/* Rings around the trunk and the leg on +X, of the given length, or `length` 0: of the girth. False where
 * there is neither. */
bool tl_body_trunk_ring(const struct tl_body *body, double y, double length, struct tl_ring *out);
bool tl_body_leg_ring(const struct tl_body *body, double y, double length, struct tl_ring *out);

#endif
