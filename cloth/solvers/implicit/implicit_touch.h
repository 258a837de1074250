/* Contact while `settle` solves: what each particle may do of its step.
 *
 * A particle on a plane sticks (its step is given), or slips: its way along the normal is given, and friction
 * is a resistance mu N / |slip| against slipping, with the last pressure N and the slip that is expected, so
 * that it never pushes the particle on. Below least_slip it sticks. What the reactions say of that is assumed
 * next: one that pulls lets go, one that rubs harder than mu N slips. Threads: pure. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_IMPLICIT_TOUCH_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_IMPLICIT_TOUCH_H

#include "cloth/contact/contact.h"
#include "cloth/solvers/implicit/implicit_solve.h"

enum tl_touch_kind { TL_FREE, TL_STICKS, TL_SLIPS };

struct tl_touch {
    enum tl_touch_kind kind;
    bool near; /* has a plane in this step */
    struct tl_contact_plane plane;
    double grip;       /* N, the most that friction pushes */
    double resistance; /* N/m, against slipping */
    double slips[2];   /* m, of the last step and of this one */
};

/* At a substep's start: finds the plane of a particle at x that inertia would carry by `way`. */
void tl_touch_begin(struct tl_touch *touch, struct tl_contacts *contacts,
                    const struct tl_contact_params *params, size_t particle, vec3d x, vec3d way);

/* What a particle may do, and what of its step is given. */
struct tl_filter tl_touch_filter(const struct tl_touch *touch, vec3d *given);

/* After a solve: `step` is its way, `reaction` (N) what pushed it besides what the solver knows, `inertia`
 * (N/m) what it resists a step with when it is alone. Returns whether it does what was assumed; else what it
 * does is assumed from now on. */
bool tl_touch_judge(struct tl_touch *touch, const struct tl_contact_params *params, vec3d step,
                    vec3d reaction, double inertia);

#endif
