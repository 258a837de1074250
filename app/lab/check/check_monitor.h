/* Monitors the cloth of a run from frame to frame: its weight, the forces that drive it, and from them the
 * bounds of its speed and its energy.
 *
 * Metres, seconds, newtons, joules. Ownership: borrows session and settings, owns the wearer's last pose.
 * Threads: one at a time. */
#ifndef TOILE_APP_LAB_CHECK_CHECK_MONITOR_H
#define TOILE_APP_LAB_CHECK_CHECK_MONITOR_H

#include "app/lab/check/checked.h"

struct tl_cloth_monitor {
    tl_session *session;
    const struct tl_settings *settings;
    double weight_n; /* of the garment in its rest shape */
    bool was_held;   /* by the hand, in any frame so far */
    /* NaN: not known yet. */
    double min_energy_j, first_strain;
    double centre[2]; /* of mass, x and z, in the first frame that nothing drives it in */
    vec3s *wearer;    /* positions one frame ago; NULL: none */
};

/* Release with tl_cloth_monitor_release. */
struct tl_cloth_monitor tl_cloth_monitor_begin(tl_session *session, const struct tl_settings *settings);
void tl_cloth_monitor_release(struct tl_cloth_monitor *watch);

/* Measures the cloth of the next frame. `is_changed`: the solver's settings changed, so that energies of
 * successive frames cannot be compared. */
struct tl_checked_cloth tl_cloth_monitor_measure(struct tl_cloth_monitor *watch, const tl_frame *frame,
                                                 bool is_held, bool is_changed);

#endif
