/* Penalty contact of `settle` for contact samples: points inside coarse triangles that must stay outside as
 * vertices must.
 *
 * A sample is a weighted mean of three vertices, so it cannot be enforced by fixing a particle's step, as
 * contact_constraint.h does. It acts as a stiff spring against its plane instead,
 *     E = k/2 max(min_normal_step + shift - n.d, 0)^2,     d the sample's step, n the plane's normal,
 * where `shift` is the spring's compression at the end of the last step (the method of multipliers [Hestenes
 * 1969]): under a steady load the sample then ends on its plane, not below it by load / k. Friction on
 * samples is left to tl_contacts_solve.
 *
 * The active set is found by iteration: a sample that would pass its plane becomes active and the system is
 * solved again, one that would be pulled becomes inactive. Threads: pure. */
#ifndef TOILE_CLOTH_SOLVERS_IMPLICIT_PENALTY_CONTACT_H
#define TOILE_CLOTH_SOLVERS_IMPLICIT_PENALTY_CONTACT_H

#include "cloth/contact/contact.h"
#include "cloth/solvers/implicit/stiffness.h"

struct tl_penalty_contact {
    bool active;                   /* its spring is part of the matrix and the load */
    bool has_plane;                /* in this step */
    struct tl_contact_plane plane; /* its min_normal_step includes the shift */
    double stiffness;              /* N/m */
    double shift;                  /* m, the spring's compression at the end of the last step */
};

/* At the start of a substep, with particles at `x`: finds the planes of the contacts' samples. `penalties` is
 * [contacts->sample_count]; `inertia` [particle] and `min_stiffness` are in N/m. */
void tl_penalty_contacts_begin(struct tl_penalty_contact *penalties, struct tl_contacts *contacts,
                               const struct tl_contact_params *params, const vec3d *x, const double *inertia,
                               double min_stiffness);

/* Adds the active springs to a newly assembled matrix and its load. */
void tl_penalty_contacts_add(const struct tl_penalty_contact *penalties, const struct tl_contacts *contacts,
                             struct tl_stiffness *stiffness, vec3d *load);

/* After a solve for `step` [particle]: returns whether the active set was right; else corrects it, in the
 * matrix and the load too. */
bool tl_penalty_contacts_update(struct tl_penalty_contact *penalties, const struct tl_contacts *contacts,
                                const vec3d *step, struct tl_stiffness *stiffness, vec3d *load);

#endif
