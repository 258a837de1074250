/* Planes between near features of the cloth, and what they allow a vertex (self_contact.h). Metres. Errors:
 * none. Threads: pure. */
#ifndef TOILE_CLOTH_SELF_CONTACT_PLANES_H
#define TOILE_CLOTH_SELF_CONTACT_PLANES_H

#include "cloth/self_contact/near.h"

/* A vertex's displacement d from its base satisfies d.normal <= room. */
struct tl_self_contact_plane {
    vec3d normal;
    double room;
    double gain;   /* m, what moving on with its pair adds to room; within an exchange it is part of room */
    uint32_t pair; /* of the list; TL_NONE: a plane on the body */
    uint8_t stage; /* of its exchange (exchange.h) */
};

/* Distance that a plane keeps on either side. Without it each window under pressure would halve the gap, down
 * to the rounding of drawn positions; features that are nearer come no nearer. */
#define TL_SELF_CONTACT_FLOOR_M 2e-5
/* Share of the distance that is safe without a plane: a ball of it about each vertex. */
#define TL_SELF_CONTACT_UNPLANED_SHARE 0.45
/* Features that are nearer have no direction from one to the other: they may come apart, or cross and be
 * found. */
#define TL_SELF_CONTACT_TOUCHING_M 1e-9

/* Planes of a pair's vertices, which are at `at` and want to be at `to` when the substep ends; `normal` is
 * the direction from the first feature's nearest point to the second one's, at `distance`; `size` [vertex] is
 * struct tl_self_contact's. Rooms are those of displacements from `at`. False if the vertices do not show a
 * plane that separates them safely. */
bool tl_self_contact_planes_of(const struct tl_near_pair *pair, const double *size, const vec3d at[4],
                               const vec3d to[4], vec3d normal, double distance,
                               struct tl_self_contact_plane planes[4]);

/* The displacement nearest to `d` that satisfies a ball of `radius` and the planes, as far as a few
 * projections find it; then as much of the way to it from `safe`, which keeps to them, as keeps to all. Sets
 * *stopped if a plane has stopped it. */
vec3d tl_self_contact_bounded(vec3d d, vec3d safe, double radius, const struct tl_self_contact_plane *planes,
                              size_t plane_count, bool *stopped);

/* Whether ball and planes allow a displacement, but for rounding. */
bool tl_self_contact_allows(vec3d d, double radius, const struct tl_self_contact_plane *planes,
                            size_t plane_count);

#endif
