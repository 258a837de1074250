/* Chooses the shadow maps to redraw when there is no time for all. Pure.
 *
 * A map's turn comes by the energy of its region times how much its shadow changes while it waits: its age,
 * times the motion, over how soft the shadow is. No map gets older than the cap. */
#ifndef TOILE_RENDER_VISIBILITY_MAP_ORDER_H
#define TOILE_RENDER_VISIBILITY_MAP_ORDER_H

#include <stdbool.h>

struct tl_map_wait {
    float energy;   /* of the region, any unit */
    float softness; /* rad: over which its light is spread */
    int age;        /* frames that moved since it was drawn; at least 1 */
};

/* In how many frames all have had their turn when `most` are drawn in each, and as many again. */
int tl_map_age_cap(int count, int most);

/* Marks `most` of `count` maps, and more only where the cap demands it; all when `most` is 0 or larger. */
void tl_map_order(const struct tl_map_wait *waits, int count, int most, bool due[]);

#endif
