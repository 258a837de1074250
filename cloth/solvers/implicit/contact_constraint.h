/* Contact of `settle`'s particles: each particle near a plane is free, sticks or slips during a step.
 *
 * Sticking: the whole step is prescribed, the plane's own motion. Slipping: the step along the normal is
 * prescribed, and friction resists the tangential motion as a viscous force mu N / |slip| * slip, with the
 * normal force N of the last solve and the slip extrapolated from the last steps. A resistance can only slow
 * a particle, so an N that was wrong never drives it. Slower than min_slip_speed it sticks.
 *
 * Which of the three holds is found by iteration (an active set): each solve's reaction decides the next
 * state. A particle whose reaction pulls becomes free, one that sticks with more than mu N tangentially
 * slips. Threads: pure. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_CONTACT_CONSTRAINT_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_CONTACT_CONSTRAINT_H

#include "cloth/contact/contact.h"
#include "cloth/solvers/implicit/conjugate_gradient.h"

enum tl_contact_state { TL_CONTACT_FREE, TL_CONTACT_STICKS, TL_CONTACT_SLIPS };

struct tl_contact_constraint {
    enum tl_contact_state state; /* assumed by the next solve */
    bool has_plane;              /* in this step */
    struct tl_contact_plane plane;
    double max_friction; /* N, Coulomb's bound mu N */
    double resistance;   /* N/m: friction force over tangential step */
    double slips[2];     /* m, tangential step relative to the plane: in the last step, in this one */
};

/* At the start of a substep: finds the plane of a particle at `x` that inertia alone would move by `step`. */
void tl_contact_constraint_begin(struct tl_contact_constraint *constraint, struct tl_contacts *contacts,
                                 const struct tl_contact_params *params, size_t particle, vec3d x,
                                 vec3d step);

/* The degrees of freedom that the assumed state leaves; `prescribed` is set to the part of the step (m) that
 * it fixes. */
struct tl_motion_filter tl_contact_constraint_filter(const struct tl_contact_constraint *constraint,
                                                     vec3d *prescribed);

/* After a solve: `step` (m) is the particle's, `reaction` (N) the force that contact had to add for it,
 * `inertia` (N/m) the particle's own resistance to a step. Returns whether the assumed state was right; else
 * changes it. */
bool tl_contact_constraint_update(struct tl_contact_constraint *constraint,
                                  const struct tl_contact_params *params, vec3d step, vec3d reaction,
                                  double inertia);

#endif
