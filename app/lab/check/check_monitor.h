/* The cloth of a run, watched from frame to frame: what it weighs, what works on it, and so how fast it may
 * be and what energy it may draw on.
 *
 * Metres, seconds, newtons, joules. Ownership: borrows session and settings, owns the wearer's last pose.
 * Threads: one at a time. */
#ifndef TOILE_APP_LAB_CHECK_CHECK_MONITOR_H
#define TOILE_APP_LAB_CHECK_CHECK_MONITOR_H

#include "app/lab/check/checked.h"

struct tl_cloth_monitor {
    tl_session *session;
    const struct tl_settings *settings;
    double weight_n; /* of the garment as it was cut */
    bool was_held;   /* by the hand, in any frame so far */
    /* NaN: not known yet. */
    double least_energy_j, first_strain;
    double centre[2]; /* of mass, x and z, in the first frame that nothing drives it in */
    vec3s *wearer;    /* positions one frame ago; NULL: none */
};

struct tl_cloth_monitor tl_cloth_monitor_begin(tl_session *session, const struct tl_settings *settings);
void tl_cloth_monitor_release(struct tl_cloth_monitor *watch);

/* The cloth in a frame, one after the other; what `checked` holds of those before is of the frames so far.
 * `is_changed`: more than the hand works on it, so that its energy says nothing. */
struct tl_checked_cloth tl_cloth_monitor_measure(struct tl_cloth_monitor *watch, const tl_frame *frame,
                                                 bool is_held, bool is_changed);

#endif
