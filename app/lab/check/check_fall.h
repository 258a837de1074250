/* The garment alone in the air, without wearer, ground, wind and hand: its centre of mass must fall as a body
 * does that air slows in proportion to its speed, y'' = -g - d y', whatever the cloth does about it. */
#ifndef TOILE_APP_LAB_CHECK_CHECK_FALL_H
#define TOILE_APP_LAB_CHECK_CHECK_FALL_H

#include "app/scene/session.h"

struct tl_fall {
    bool is_measured; /* only of cloth that began at rest, with gravity, without pins and open seams */
    double fallen_m, expected_m;
    double sideways_m; /* of the centre of mass */
    double tolerance;  /* relative, of the solver's own step */
};

/* Resets the session's cloth, takes wearer and wind away and simulates a third of a second. The session is
 * then good for nothing but its end. Errors: as tl_cloth_step. Threads: the session's. */
bool tl_fall_measure(tl_session *session, const struct tl_settings *settings, struct tl_fall *out,
                     tl_error *error);

#endif
