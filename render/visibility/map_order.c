#include "render/visibility/map_order.h"

#include "config/base/memory.h"

#include <stdlib.h>

#define SHARPEST 0.02f /* rad: a texel's part; what is sharper moves no more */

struct turn {
    float urgency;
    int index;
};

/* Descending urgency; among equals the lower index first. */
static int compare_turns(const void *a, const void *b)
{
    const struct turn *left = a, *right = b;
    if (left->urgency != right->urgency) // NOLINT: whether they are equals
        return left->urgency > right->urgency ? -1 : 1;
    return left->index - right->index;
}

int tl_map_age_cap(int count, int maximum)
{
    return 2 * ((count + maximum - 1) / maximum);
}

void tl_map_order(const struct tl_map_wait *waits, int count, int maximum, bool due[])
{
    bool all = maximum <= 0 || maximum >= count;
    struct turn *turns = TL_NEW_ARRAY(struct turn, (size_t)count);
    int taken = 0;
    for (int i = 0; i < count; i++) {
        const struct tl_map_wait *wait = &waits[i];
        due[i] = all || wait->age >= tl_map_age_cap(count, maximum);
        taken += due[i];
        float change = (float)wait->age / (wait->softness > SHARPEST ? wait->softness : SHARPEST);
        turns[i] = (struct turn){wait->energy * change, i};
    }
    qsort(turns, (size_t)count, sizeof *turns, compare_turns);
    for (int i = 0; i < count && taken < maximum; i++)
        if (!due[turns[i].index]) {
            due[turns[i].index] = true;
            taken++;
        }
    free(turns);
}
