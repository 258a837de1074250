/* Contact of particles with a moving collider and the ground, with Coulomb friction.
 *
 * Each particle caches the tangent plane at its nearest point of the avatar. The collider is queried again
 * only when the particle has moved further than the plane is valid. Cloth at rest therefore makes no queries
 * and does not jitter between two nearest points. The plane moves with its triangle during the frame.
 * Penetration that existed before the substep is removed at a limited speed, because removing it at once
 * would add energy.
 *
 * A step calls tl_contacts_update at its start, tl_contacts_solve in each substep and
 * tl_contacts_enforce at its end. A probe is a contact sample between vertices. Metres, seconds, world axes
 * with y up. Errors: none. Lifetime: the contacts own their arrays; the collider must outlive the frame.
 * Threads: pure. */
#ifndef TOILE_CLOTH_CONTACT_CONTACT_H
#define TOILE_CLOTH_CONTACT_CONTACT_H

#include "cloth/contact/collider.h"
#include "cloth/contact/peaks.h"
#include "cloth/contact/sample.h"
#include "cloth/mesh/particles.h"
#include "config/base/simd.h"

struct tl_contact_cache {
    vec3d query_point;  /* position for which the collider was queried */
    vec3d anchor[2];    /* nearest point of the collider, at the frame's start and end */
    vec3d normal;       /* outward */
    double query_phase; /* 0 to 1 within the frame; above 1: not queried yet */
    double clearance;   /* m the particle may move relative to the anchor before the next query */
    bool near;          /* the collider is within reach: anchor and normal are valid */
};

struct tl_contacts {
    const struct tl_topology *topology; /* borrowed */
    size_t particle_count, probe_count;
    size_t sample_count;               /* probes, and after them peaks: cloth in front of pointed skin */
    struct tl_contact_sample *samples; /* [sample_count] */
    struct tl_contact_cache *caches;   /* [particle_count + sample_count] */
    struct tl_skin_grid skin;          /* pointed skin at skin_phase of `revision` */
    double skin_phase;
    bool *caught;          /* [particle_count] caught in this frame so far */
    bool *pinched;         /* [particle_count] caught in the last frame, or in the last one in which
                              the collider moved: one plane does not describe both parts */
    double *allowed_depth; /* [particle_count] m by which a particle may still be deeper than the thickness:
                        its initial penetration less the part removed so far; HUGE_VAL: not measured yet */
    bool *slipped; /* [particle_count] moved by cloth/contact/caught.h, which ignores the planes; cleared by
                tl_contacts_enforce and tl_contacts_lift */
    double *released_s;  /* [particle_count] for which contact is still left out (tl_contacts_let_go) */
    size_t caught_count; /* particles caught in this frame */
    uint64_t revision;   /* of the collider when the caches were filled */
    const tl_collider *collider;
};

/* Allocates caches and probes. Borrows the topology. The `rest` shapes [triangle_count] decide which
 * triangles are coarse enough to need probes. End with tl_contacts_release. */
struct tl_contacts tl_contacts_create(const struct tl_topology *topology, const vec2s (*rest)[3]);
void tl_contacts_release(struct tl_contacts *contacts);

/* Cloth in front of pointed skin keeps this share of the thickness above it: the skin stays below the smooth
 * surface that is drawn, and the cloth between its vertices is not pushed out by more. */
#define TL_PEAK_SHARE 0.5

/* The height that a particle or sample (index particle_count and more) keeps above the avatar, as a share of
 * the thickness. */
static inline double tl_contacts_share(const struct tl_contacts *contacts, size_t i)
{
    return i < contacts->particle_count + contacts->probe_count ? 1 : TL_PEAK_SHARE;
}

/* m/s. Removes 14 mm of penetration in 0.07 s, and adds no more energy than a fall from 2 mm: v^2 / 2g. */
#define TL_PUSH_OUT_SPEED 0.2

struct tl_contact_params {
    double friction, thickness_m;
    double push_out_speed;      /* m/s at which penetration from before the substep is removed */
    double phase_before, phase; /* of the collider's motion, at the substep's start and end */
    double h;                   /* s, the substep */
};

/* Call once per frame, after the collider has moved. Invalidates the caches if the collider changed, and
 * carries the caught flags of the last frame over to `pinched`. */
void tl_contacts_begin(struct tl_contacts *contacts, const tl_collider *collider);

/* Invalidates all caches, for particles that were placed elsewhere. */
void tl_contacts_forget(struct tl_contacts *contacts);

/* Call once per step, at its start, with the positions `x`. Searches for peaks of the skin, queries the
 * collider for every invalid cache, and also for the near ones while the collider moves, because a cached
 * plane is translated but not rotated. */
void tl_contacts_update(struct tl_contacts *contacts, const vec3d *x, double thickness_m, double phase);

/* Height of a particle above the nearer of avatar and ground, as far as the caches know: returns false if
 * neither is known to be near. */
struct tl_contact_height {
    vec3d up; /* outward, unit */
    double height_m;
};
bool tl_contacts_height(const struct tl_contacts *contacts, size_t particle, vec3d x, double phase,
                        struct tl_contact_height *out);
/* The same of any point, by a query: for particles whose caches are not filled yet. */
bool tl_contacts_height_asked(const tl_collider *collider, vec3d x, struct tl_contact_height *out);

/* Moves particles and probes out of the collider and applies friction to their displacement. Call it after
 * the other constraints of the substep: they could push particles back inside. */
void tl_contacts_solve(struct tl_contacts *contacts, const struct tl_contact_params *params,
                       struct tl_particles *particles);

/* The velocity half of RATTLE [Andersen 1983]. Call it after velocities have changed since tl_contacts_solve,
 * as by the second half kick of Verlet. Removes the approaching normal velocity of every particle and probe
 * in contact, and applies Coulomb friction bounded by that normal impulse. */
void tl_contacts_solve_velocities(const struct tl_contacts *contacts, const struct tl_contact_params *params,
                                  struct tl_particles *particles);

/* Whether a particle was caught in this frame or the last one. */
static inline bool tl_contacts_is_pinched(const struct tl_contacts *contacts, size_t particle)
{
    return contacts->caught[particle] || contacts->pinched[particle];
}

/* Call once per step, at its end, with the step's own duration and phases. Queries the surface itself and
 * moves particles that the substeps' planes have missed: afterwards no particle is deeper in the avatar than
 * before the step, and none has entered it. A particle between two parts of the avatar is moved whatever
 * strain that causes. A particle that was moved here, or whose `slipped` flag is set near the avatar, is
 * marked as caught. */
void tl_contacts_enforce(struct tl_contacts *contacts, const struct tl_contact_params *step,
                         struct tl_particles *particles);

/* Moves particles outside that were moved into the avatar after tl_contacts_enforce of the same step, and
 * marks them as caught. Returns whether there were any. */
bool tl_contacts_lift(struct tl_contacts *contacts, const struct tl_contact_params *step,
                      struct tl_particles *particles);

/* Leaves out contact with the avatar, for a tenth of a second or until they are outside again, of particles
 * that are inside after all: the avatar has left no place for them, as between an arm and a hip that pass
 * through each other. Call it last in a step. */
void tl_contacts_let_go(struct tl_contacts *contacts, const struct tl_contact_params *step,
                        const struct tl_particles *particles);

/* Projects a point that moved from `before` to `x` to the outer side of a plane, and applies Coulomb
 * friction. The plane passes at `thickness_m` above the point `surface`, which moved there from
 * `surface_before`.
 *
 * Normal: depth = thickness - (x - surface).normal. The part of the old depth that push_out_speed does not
 * remove in this substep is kept. Tangential: the slip relative to the surface is reduced by at most mu *
 * pressed_in (position-based Coulomb friction). pressed_in leaves the old penetration out, because removing
 * it is not a load: with it, deep particles would stick. */
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
    double pressed_in = fmax(depth - depth_before, 0); /* caused by load, without the old penetration */
    double max_friction = params->friction * pressed_in;
    return vec3d_muladd(x, slip, length > max_friction ? -max_friction / length : -1);
}

#endif
