/* Probes while `settle` solves: points inside coarse triangles that must stay outside as vertices must.
 *
 * A point has no directions of its own to give away, so it presses as a stiff spring against its plane,
 *     k/2 max(least + gave - n.d, 0)^2,
 * with what the spring gave in the last step (the method of multipliers): under a steady load it stands on
 * its plane. Friction on it is left to tl_contacts_solve. Ones that would pass their plane press from then
 * on, ones that would be pulled let go. Threads: pure. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_IMPLICIT_PRESS_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_IMPLICIT_PRESS_H

#include "cloth/contact/contact.h"
#include "cloth/solvers/implicit/implicit_matrix.h"

struct tl_press {
    bool presses;
    bool near; /* has a plane in this step */
    struct tl_contact_plane plane;
    double stiffness; /* N/m */
    double gave;      /* m, in the last step: how much farther it pushes in this one */
};

/* At a substep's start at x: finds the planes of the contacts' probes; `presses` [contacts->probe_count].
 * `inertia` [particle] and `least_stiffness` in N/m. */
void tl_presses_begin(struct tl_press *presses, struct tl_contacts *contacts,
                      const struct tl_contact_params *params, const vec3d *x, const double *inertia,
                      double least_stiffness);

/* Adds those that press to a newly assembled matrix and its load. */
void tl_presses_add(const struct tl_press *presses, const struct tl_contacts *contacts,
                    struct tl_stiffness *stiffness, vec3d *load);

/* After a solve for `step` [particle]: whether all did what was assumed; else the matrix and the load are
 * mended. */
bool tl_presses_judge(struct tl_press *presses, const struct tl_contacts *contacts, const vec3d *step,
                      struct tl_stiffness *stiffness, vec3d *load);

#endif
