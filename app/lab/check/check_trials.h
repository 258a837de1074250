/* Trials of the scene's fabric with the scene's solver whose outcomes are known, whatever the garment is. */
#ifndef TOILE_APP_LAB_CHECK_CHECK_TRIALS_H
#define TOILE_APP_LAB_CHECK_CHECK_TRIALS_H

#include "app/scene/session.h"

/* The garment alone in the air, without wearer, ground, wind and hand: its centre of mass must fall as a body
 * does that air slows in proportion to its speed, y'' = -g - d y', whatever the cloth does about it. Only of
 * cloth that began at rest, with gravity, without pins and open seams. */
struct tl_fall {
    bool is_measured;
    double fallen_m, expected_m;
    double sideways_m; /* of the centre of mass */
    double tolerance;  /* relative, of the solver's own step */
};

/* Strips along the weft and along the warp, clamped at one end: they droop as the elastica of the fabric's
 * bending stiffness and weight (app/lab/experiments/closed_form.h). Only of fabrics that resist bending, with
 * gravity. */
struct tl_droop {
    bool is_measured;
    const char *along;                  /* the worse one: "weft" or "warp" */
    double length_m, tip_m, expected_m; /* of the strip; its end below the clamp */
};

/* A sheet on an incline whose tangent exceeds the friction by SLOPE_EXCESS: it slides with
 * x'' = g (sin - friction cos) - d x'. */
struct tl_slide {
    bool is_measured; /* with gravity */
    double friction, slid_m, expected_m;
    double tolerance; /* relative, of the solver's own step */
};

struct tl_trials {
    struct tl_fall fall;
    struct tl_droop droop;
    struct tl_slide slide;
};

/* Resets the session's cloth, takes wearer and wind away and simulates a third of a second; then strips and
 * sheet of their own. The session is then good for nothing but its end. Without simulated cloth nothing is
 * measured. Errors: as tl_cloth_step. Threads: the session's. */
bool tl_trials_run(tl_session *session, const struct tl_settings *settings, struct tl_trials *out,
                   tl_error *error);

#endif
