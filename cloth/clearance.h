/* How far each vertex of the cloth is from what is around it: the room that a drawn surface has which does
 * not lie in the cloth itself. Threads: parallel inside, with the same results at any number of threads. */
#ifndef TOILE_CLOTH_CLEARANCE_H
#define TOILE_CLOTH_CLEARANCE_H

#include "cloth/cloth.h"

struct tl_clearance {
    vec3s up;       /* outward unit normal of the tangent plane of avatar or ground near the vertex */
    float height_m; /* of the vertex above it; INFINITY: nothing is near */
    float room_m;   /* surfaces whose points are no farther from the cloth than their vertices' rooms do not
                       cross where the cloth does not */
};

/* Of the physics vertices below `count`, with the `collider` of the last frame. */
void tl_cloth_clearances(const tl_cloth *cloth, const tl_collider *collider, size_t count,
                         struct tl_clearance *out);

#endif
