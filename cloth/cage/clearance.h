/* Distance of each vertex of the cloth from what is around it: the room that a drawn surface has which does
 * not lie in the cloth itself. Threads: parallel inside, with the same results at any number of threads. */
#ifndef TOILE_CLOTH_CAGE_CLEARANCE_H
#define TOILE_CLOTH_CAGE_CLEARANCE_H

#include "cloth/cloth.h"

struct tl_clearance {
    vec3s up;       /* outward unit normal of the tangent plane of avatar or ground near the vertex */
    float height_m; /* of the vertex above it; INFINITY: nothing is near */
    float room_m;   /* half of the distance to other cloth, or of what is known of it: where a surface's
                       points are nowhere farther from the cloth, it crosses itself only where the cloth does.
                       INFINITY: nothing keeps the cloth from crossing itself */
};

/* The share of the way `moved` that a point `flat` of the cloth may go, as far as one of the vertices around
 * it knows, which is at `end`: towards a body to 1 mm above it, and no farther where the cloth itself is
 * lower; and no farther than its room. */
float tl_clearance_share(const struct tl_clearance *clearance, vec3s end, vec3s flat, vec3s moved);

/* Writes out[v] of each physics vertex v (tl_cloth_weld), with the `collider` of the last frame or of
 * settling; NULL: there is none. Takes 0.5 ms for 3,000 vertices that have moved, 12 ms before they have.
 * Errors: none. */
void tl_cloth_clearances(const tl_cloth *cloth, const tl_collider *collider, struct tl_clearance *out);

#endif
