/* Chooses the shadow maps to redraw when there is no time for all. Pure.
 *
 * Maps are redrawn in order of the energy of their region times the change of the shadow since: age times
 * motion, divided by the softness of the shadow. No map gets older than a cap. */
#ifndef TOILE_RENDER_VISIBILITY_MAP_ORDER_H
#define TOILE_RENDER_VISIBILITY_MAP_ORDER_H

#include <stdbool.h>

struct tl_map_wait {
    float energy;   /* of the region, any unit */
    float softness; /* rad: over which its light is spread */
    int age;        /* frames that moved since it was drawn; at least 1 */
};

/* The cap: twice the number of frames in which every map is drawn once if `maximum` are drawn in each. */
int tl_map_age_cap(int count, int maximum);

/* Marks `maximum` of `count` maps, and more only if the cap requires it; all if `maximum` is 0 or at least
 * `count`. */
void tl_map_order(const struct tl_map_wait *waits, int count, int maximum, bool due[]);

#endif
