/* Contact of particles with a moving collider and the ground, with Coulomb friction.
 *
 * Each particle remembers the plane at its nearest point of the avatar and asks again only once it has moved
 * far enough along it to matter; cloth that rests asks nothing, and does not jitter between two answers. The
 * plane moves with its triangle during the frame. Penetration that was there before the substep is taken out
 * at a limited speed. Threads: pure. */
#ifndef TOILE_CLOTH_CONTACT_CONTACT_H
#define TOILE_CLOTH_CONTACT_CONTACT_H

#include "cloth/contact/collider.h"
#include "cloth/contact/sample.h"
#include "cloth/mesh/particles.h"
#include "config/simd.h"

struct tl_contact_cache {
    vec3d query_point;  /* where the particle was when the collider was asked */
    vec3d anchor[2];    /* nearest point, at the frame's start and end */
    vec3d normal;       /* outward */
    double query_phase; /* 0 to 1 within the frame; above 1: never asked */
    double clearance;   /* m the particle may move against the anchor before asking again */
    bool near;          /* an anchor was found */
};

struct tl_contacts {
    size_t particle_count, sample_count;
    struct tl_contact_sample *samples;
    struct tl_contact_cache *caches; /* [particle_count + sample_count] */
    bool *caught;                    /* [particle_count] in this frame, so far */
    bool *pinched;                   /* [particle_count] caught in the last frame, or in the last one in which
                                        the collider moved: one plane alone says too little of where it is */
    double *allowed_depth; /* [particle_count] m below the offset that a particle may still be: what it began
                        with, less what has been taken out; HUGE_VAL: never looked */
    bool *slipped; /* [particle_count] moved by cloth/contact/caught.h, which knows nothing of planes; cleared
                      once heeded */
    size_t caught_count; /* of those */
    uint64_t revision;   /* of the collider when the caches were filled */
    const tl_collider *collider;
};
/* `rest` shapes decide which triangles are coarse. */
struct tl_contacts tl_contacts_create(const struct tl_topology *topology, const vec2s (*rest)[3]);
void tl_contacts_release(struct tl_contacts *contacts);

/* 14 mm in 0.07 s, and no more energy than a fall from 2 mm. */
#define TL_PUSH_OUT_SPEED 0.2

struct tl_contact_params {
    double friction, thickness_m;
    double push_out_speed;      /* m/s: how fast penetration that was there before is taken out */
    double min_slip_speed;      /* m/s, of solvers that heed planes while they solve: slower is no slip */
    double phase_before, phase; /* of the collider's motion at the start and the end of the substep */
    double h;                   /* s */
};

/* Once per frame: forgets what no longer holds. */
void tl_contacts_begin(struct tl_contacts *contacts, const tl_collider *collider);

/* The particles have been put elsewhere: all planes are asked for anew. */
void tl_contacts_forget(struct tl_contacts *contacts);

/* Once per step, at its start: asks for all who were never asked, and for the near ones when the collider
 * moves, because its planes turn. On all threads. */
void tl_contacts_update(struct tl_contacts *contacts, const vec3d *x, double thickness_m, double phase);

/* A plane that a particle may not pass during a substep, for a solver that heeds it while it solves: its way
 * d (m) obeys d.normal >= least. */
struct tl_contact_plane {
    vec3d normal;           /* outward, unit */
    vec3d motion;           /* m, of the surface during the substep */
    double min_normal_step; /* m; starting penetration is taken out at a limited speed */
};
#define TL_CONTACT_PLANES 2 /* the avatar's and the ground's */

/* Those of a particle, or of probe i as particle_count + i, that starts at x; returns how many. */
size_t tl_contacts_planes(struct tl_contacts *contacts, const struct tl_contact_params *params,
                          size_t particle, vec3d x, struct tl_contact_plane out[TL_CONTACT_PLANES]);

/* Moves particles and probes out of the collider; after the constraints, so that nothing is inside at a
 * substep's end.
 */
void tl_contacts_solve(struct tl_contacts *contacts, const struct tl_contact_params *params,
                       struct tl_particles *particles);

/* After a substep that has moved particles by tl_contacts_solve and then pushed on, as half a kick of Verlet
 * does: no particle or probe that touches goes on into what it touches, whose impulse rubs too (the second
 * half of RATTLE, Andersen 1983). */
void tl_contacts_solve_velocities(const struct tl_contacts *contacts, const struct tl_contact_params *params,
                                  struct tl_particles *particles);

/* Whether a particle was caught lately: new contacts have to be told. */
static inline bool tl_contacts_is_pinched(const struct tl_contacts *contacts, size_t particle)
{
    return contacts->caught[particle] || contacts->pinched[particle];
}

/* Once per step, at its end, with the step's own duration and phases: whatever the substeps' planes have
 * missed, no particle is deeper in the avatar than it was before, and none that was outside is inside. Where
 * two parts of the avatar press on one particle the price is strain; what was put back so, or has slipped
 * past a part, is caught in this frame. */
void tl_contacts_enforce(struct tl_contacts *contacts, const struct tl_contact_params *step,
                         struct tl_particles *particles);

/* Where a point goes that is driven from `before` to `x`: to the outer side of a plane through `surface`,
 * which was at `surface_before`, with Coulomb friction, which bounds the slip by mu times the normal
 * correction. */
TL_INLINE vec3d tl_contact_push_out(vec3d x, vec3d before, vec3d surface, vec3d surface_before, vec3d normal,
                                    const struct tl_contact_params *params)
{
    double depth = params->thickness_m - vec3d_dot(vec3d_sub(x, surface), normal);
    if (!(depth > 0))
        return x;
    double depth_before = fmax(params->thickness_m - vec3d_dot(vec3d_sub(before, surface_before), normal), 0);
    double kept = fmax(depth_before - params->push_out_speed * params->h, 0);
    double correction = depth - kept;
    if (!(correction > 0))
        return x;
    x = vec3d_muladd(x, normal, correction);
    vec3d slip = vec3d_sub(vec3d_sub(x, before), vec3d_sub(surface, surface_before));
    slip = vec3d_muladd(slip, normal, -vec3d_dot(slip, normal));
    double length = vec3d_norm(slip);
    double pressed_in = fmax(depth - depth_before, 0); /* what load pushed in, without the old penetration */
    double max_friction = params->friction * pressed_in;
    return vec3d_muladd(x, slip, length > max_friction ? -max_friction / length : -1);
}

#endif
