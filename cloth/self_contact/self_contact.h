/* Contact of the cloth with itself: no two of its triangles cross, whatever moves them.
 *
 * For each pair of near features (near.h) whose nearest points are a and b, the plane half way between them,
 * with normal (b - a) / |b - a|, has one feature on each side. While each of the four vertices stays on its
 * side, the pair cannot touch; pairs that are not near cannot touch while each vertex stays within a ball.
 * Given planes and balls, every vertex is bounded on its own: it is projected back on its side ("Divide and
 * Truncate" in NVIDIA's Newton; the balls are those of [Chen et al. 2025]). Results do not depend on an order
 * or on the number of threads.
 *
 * A window is the time for which planes and balls hold. It ends when a vertex nears the rim of its ball, so
 * that cloth at rest searches nothing. Planes and balls move by the affine motion that fits the cloth's
 * velocities best: affine maps keep sides.
 *
 * Truncation is the guarantee and knows neither thickness nor friction; contacts do: a pair that is nearer
 * than `kept` is pushed apart, by mass, with Coulomb friction.
 *
 * Cloth is carried by cloth that lies on the body (avatar or ground): one sweep over contacts moves a stack
 * of n sheets by one nth of what its weight needs, so the stack would be pressed together, and creep down a
 * slope. A second sweep goes from the body outwards and moves the upper feature of each contact only, as if
 * the lower one were fixed ("shock propagation" in [Guendelman et al. 2003]).
 *
 * Cloth that comes crossed is untangled (untangle.h) before all this holds.
 *
 * Each substep calls tl_self_contact_renew if tl_self_contact_is_due, tl_self_contact_solve, after contact
 * with the body tl_self_contact_carry, and after all other constraints tl_self_contact_truncate. Metres,
 * seconds. Errors: none. Lifetime: a plain struct that owns its arrays; it starts as {0}. The topology must
 * outlive it. Threads: one call at a time. */
#ifndef TOILE_CLOTH_SELF_CONTACT_SELF_CONTACT_H
#define TOILE_CLOTH_SELF_CONTACT_SELF_CONTACT_H

#include "cloth/contact/contact.h"
#include "cloth/mesh/particles.h"
#include "cloth/self_contact/affine.h"
#include "cloth/self_contact/planes.h"
#include "cloth/self_contact/untangle.h"

/* A pair of features in contact. Its gap is normal . sum of weights[i] x[v[i]]; weights of the first feature
 * are negative. */
struct tl_self_contact_pair {
    uint32_t v[4];
    double weights[4];
    vec3d normal; /* from the first feature to the second */
    double kept;  /* m */
    bool edges;   /* as in struct tl_near_pair */
};

struct tl_self_contact_pairs {
    size_t count, capacity;
    struct tl_self_contact_pair *pairs;
};

/* The vector from the first feature's point to the second one's, of a contact at positions x. */
vec3d tl_self_contact_between(const struct tl_self_contact_pair *contact, const vec3d *x);

/* Those of v[4] that are the first feature's, or the second one's. */
struct tl_range tl_self_contact_feature(const struct tl_self_contact_pair *contact, bool first);

/* A contact in which one feature lies on the other, as seen from the body. */
struct tl_self_contact_carried {
    double height_m; /* of the lower feature */
    uint32_t contact;
    bool first; /* the first feature is the upper one */
};

/* Inputs of each call; borrowed for the call. */
struct tl_self_contact_params {
    const struct tl_topology *topology;
    const vec2s (*rest)[3]; /* [triangle] */
    const vec3d *made_at;   /* [vertex] m: pairs that were made nearer than thickness_m keep that distance */
    double thickness_m;     /* between middle surfaces of two plies */
    double friction;
    double h;                       /* the substep */
    const struct tl_contacts *body; /* NULL: nothing carries the cloth */
    double phase;                   /* of the body's motion */
    double carrier_m;               /* what is nearer to the body than this lies on it */
};

struct tl_self_contact {
    struct tl_near near;
    bool made;         /* near is that of the topology */
    bool current;      /* there is a window */
    bool rim, stopped; /* a vertex has come near its ball's rim; a plane has stopped one */
    bool late;         /* made after a substep, or with planes on the body: the next one needs another */
    int substeps;      /* of the window so far */
    double time_s;     /* of the window so far */
    double longest_s;  /* that the common motion may be continued */
    struct tl_affine velocity; /* common motion */
    struct tl_affine moved;    /* the same over time_s */
    struct tl_affine_inverse back;
    double *size;   /* [vertex] m, mean side of its triangles at rest */
    vec3d *speed;   /* [vertex] m/s, at the window's start */
    vec3d *base;    /* [vertex] m */
    double *radius; /* [vertex] m, of the balls */
    double *off;    /* [vertex] m, from the list's base, common motion taken out */
    bool *cut;      /* [vertex] of a truncation: left where it is, outside its ball or far past a plane */
    uint32_t *plane_first; /* [vertex] of `planes` */
    uint32_t *plane_count; /* [vertex] */
    uint32_t *plane_room;  /* [vertex] at least plane_count */
    size_t plane_end;      /* of `planes` in use */
    size_t plane_capacity;
    struct tl_self_contact_plane *planes;
    struct tl_self_contact_pairs contacts;
    size_t carried_count, carried_capacity;
    struct tl_self_contact_carried *carried; /* [carried_count] from the body outwards */
    bool clean;     /* no pair crosses or touches: planes then keep it so, and nothing is searched */
    bool was_clean; /* at some time since tl_self_contact_forget */
    struct tl_untangle untangle;
    size_t windows, lists; /* made since creation */
};
void tl_self_contact_release(struct tl_self_contact *self);

/* Farther past a plane, m, a vertex is not moved back before an exchange of planes, or another window, has
 * made sure that it must be: what is moved back loses its momentum. */
#define TL_SELF_CONTACT_CUT_M 5e-6

/* A state in which planes and balls hold: positions of the last truncation, and the common motion until then.
 */
struct tl_self_contact_start {
    const vec3d *x;
    struct tl_affine_inverse back;
};

/* The vertex's displacement from its base there. */
vec3d tl_self_contact_safe(const struct tl_self_contact *self, const struct tl_self_contact_start *start,
                           size_t vertex);

/* Makes room for one more plane of a vertex, which may move its planes. */
void tl_self_contact_make_room(struct tl_self_contact *self, size_t vertex);

/* Whether the way of vertex `i` ends in the body, and deeper than it began. */
bool tl_self_contact_sinks(const struct tl_self_contact_params *params, size_t i, vec3d from, vec3d to);

/* Drops what is known of the mesh, its places, or both: for cloth that was sewn, moved or restored. */
void tl_self_contact_forget(struct tl_self_contact *self);

/* Prepares for the mesh, if that has not been done since tl_self_contact_forget, and searches crossings.
 * Vertices of equal `class_of` [vertex] count as one: features that have one in common touch, which they may.
 * `class_of` is copied. */
void tl_self_contact_prepare(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                             const uint32_t *class_of, const vec3d *x);

/* Whether a window must be made before the next substep of h seconds. */
bool tl_self_contact_is_due(const struct tl_self_contact *self, double h);

/* Ends the window, for cloth that was moved as a whole. */
void tl_self_contact_end_window(struct tl_self_contact *self);

/* Makes a window. Velocities are (x - previous) / h if `velocity_from_positions`, else v. */
void tl_self_contact_renew(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                           const struct tl_particles *particles, bool velocity_from_positions);

/* Pushes pairs apart that are too near, at a substep's predicted positions. */
void tl_self_contact_solve(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                           struct tl_particles *particles);

/* Pushes pairs apart as tl_self_contact_solve does, once more in the same substep. */
void tl_self_contact_push(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                          struct tl_particles *particles);

/* Carries what lies on cloth that lies on the body, after contact with the body has moved that. */
void tl_self_contact_carry(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                           struct tl_particles *particles);

/* Makes a window in the middle of a substep, at positions `from`, whose balls hold the positions `to`. If it
 * is `still`, it knows no common motion, and no vertex enters the body that was outside before. */
void tl_self_contact_widen(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                           const vec3d *from, const vec3d *to, bool still);

/* Sets the window's time, and its common motion's place at that time. */
void tl_self_contact_set_time(struct tl_self_contact *self, double time_s);

/* Moves every vertex back that has passed a plane. Where vertices want to leave their balls, a new window is
 * made first, about the positions `from` and as wide as the ways from there, so that only what would meet on
 * these ways is held back. Where they want far past a plane, planes are exchanged first (exchange.h).
 * `from` are particles->previous within a substep; after it, the positions that the last truncation left. */
void tl_self_contact_truncate(struct tl_self_contact *self, const struct tl_self_contact_params *params,
                              const vec3d *from, struct tl_particles *particles);

#endif
