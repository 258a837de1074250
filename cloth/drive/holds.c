#include "cloth/drive/holds.h"

#include <math.h>

static double *coordinate(vec3d *x, int axis)
{
    return axis == 0 ? &x->x : axis == 1 ? &x->y : &x->z;
}

/* Distance of the particle from the plane; 0 on the side where it may be. */
static double off_plane(const struct tl_hold *hold, double at)
{
    double off = at - (double)hold->level_m;
    return hold->side * off > 0 ? 0 : off;
}

void tl_holds_draw(const struct tl_hold *holds, size_t count, const uint32_t *weld, bool hanging, double h,
                   struct tl_particles *particles)
{
    for (size_t i = 0; i < count; i++) {
        const struct tl_hold *hold = &holds[i];
        uint32_t particle = weld[hold->vertex];
        if (!(particles->w[particle] > 0) || (hold->axis == 1) != hanging)
            continue;
        double *at = coordinate(&particles->x[particle], hold->axis);
        double before = off_plane(hold, *coordinate(&particles->previous[particle], hold->axis));
        double off = off_plane(hold, *at), most = fmax(fabs(before) - TL_HOLD_SPEED * h, 0);
        if (fabs(off) > most)
            *at = (double)hold->level_m + copysign(most, off);
    }
}
