/* Untangling: cloth that comes crossed, or was crossed by its avatar, comes apart again.
 *
 * While it is not clean, crossings of an edge with a triangle are searched in every window. The pairs of
 * features by which a crossing can come out are left free (tl_untangle_is_free); no other can cross beside
 * them. Each crossing is pushed to where its contour, the line in which the cloth passes through itself, gets
 * shorter [Volino and Magnenat-Thalmann 2006]. Crossings of one contour share one direction, or they would
 * push against each other.
 *
 * Metres. Errors: none. Lifetime: a plain struct that owns its arrays; it starts as {0}. Threads: one call at
 * a time. */
#ifndef TOILE_CLOTH_SELF_CONTACT_UNTANGLE_H
#define TOILE_CLOTH_SELF_CONTACT_UNTANGLE_H

#include "cloth/mesh/particles.h"
#include "cloth/self_contact/near.h"

struct tl_untangle {
    size_t pair_count; /* crossing pairs of triangles, at the last search */
    size_t free_count, free_capacity;
    uint64_t *free_keys; /* [free_count] sorted */
    vec3d *push;         /* [vertex] direction, at most unit; NULL before the first search */
};
void tl_untangle_release(struct tl_untangle *untangle);

/* Searches the crossings at positions `x`. */
void tl_untangle_search(struct tl_untangle *untangle, struct tl_near *near, const vec3d *x);

/* Whether a pair takes part in a crossing, so that it must be able to pass. */
bool tl_untangle_is_free(const struct tl_untangle *untangle, const struct tl_near_pair *pair);

/* Pushes for a substep of h seconds. The particles gain no speed by it. */
void tl_untangle_push(const struct tl_untangle *untangle, double h, struct tl_particles *particles);

#endif
