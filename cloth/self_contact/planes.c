#include "cloth/self_contact/planes.h"

/* TL_SELF_CONTACT_FLOOR_M is at most this share of the mesh's own size there. */
#define FLOOR_SHARE 0.004
/* Projections on all planes of a vertex, one after the other, before it is moved back along its way. */
#define ROUNDS 3
/* m, rounding of a displacement. */
#define ON_PLANE_M 1e-12

/* Heights of a pair's highest vertex of the first feature and lowest one of the second. */
struct facing {
    double below, above;
};

static struct facing facing_heights(const double heights[4], int second)
{
    struct facing facing = {-HUGE_VAL, HUGE_VAL};
    for (int i = 0; i < second; i++)
        facing.below = tl_max(facing.below, heights[i]);
    for (int i = second; i < 4; i++)
        facing.above = tl_min(facing.above, heights[i]);
    return facing;
}

/* The plane is half way between the features, as the vertices themselves show it: so it separates them even
 * where the nearest points are rounded. At the substep's end it may be half way between where they want to
 * be. */
bool tl_self_contact_planes_of(const struct tl_near_pair *pair, const double *size, const vec3d at[4],
                               const vec3d to[4], vec3d normal, double distance,
                               struct tl_self_contact_plane planes[4])
{
    int second = tl_near_second(pair);
    double heights[4], later[4];
    for (int i = 0; i < 4; i++) {
        heights[i] = vec3d_dot(normal, vec3d_sub(at[i], at[0]));
        later[i] = vec3d_dot(normal, vec3d_sub(to[i], at[0]));
    }
    const struct facing now = facing_heights(heights, second), then = facing_heights(later, second);
    if (!(now.above - now.below > TL_SELF_CONTACT_UNPLANED_SHARE * distance))
        return false;
    double middle = (now.below + now.above) / 2, step = (then.below + then.above) / 2 - middle;
    for (int i = 0; i < 4; i++) {
        double side = i < second ? 1 : -1;
        double room =
            side * (middle - heights[i]) - tl_min(TL_SELF_CONTACT_FLOOR_M, FLOOR_SHARE * size[pair->v[i]]);
        planes[i] = (struct tl_self_contact_plane){
            .normal = vec3d_scale(normal, side), .room = tl_max(room, 0), .gain = side * step};
    }
    return true;
}

/* The share of the way from `safe` to `d` that is within the ball. */
static double share_within(vec3d safe, vec3d d, double radius)
{
    vec3d way = vec3d_sub(d, safe);
    double a = vec3d_dot(way, way), b = vec3d_dot(safe, way), c = vec3d_dot(safe, safe) - radius * radius;
    double root = sqrt(tl_max(b * b - a * c, 0));
    return a > 0 ? tl_max((root - b) / a, 0) : 0;
}

vec3d tl_self_contact_bounded(vec3d d, vec3d safe, double radius, const struct tl_self_contact_plane *planes,
                              size_t plane_count, bool *stopped)
{
    double length = vec3d_norm(d);
    if (length > radius)
        d = vec3d_scale(d, radius / length);
    bool outside = false;
    for (int round = 0; round < ROUNDS; round++) {
        outside = false;
        for (size_t k = 0; k < plane_count; k++) {
            double over = vec3d_dot(d, planes[k].normal) - planes[k].room;
            if (over > 0) {
                d = vec3d_muladd(d, planes[k].normal, -over);
                outside = *stopped = true;
            }
        }
        if (!outside)
            break;
    }
    double share = 1;
    for (size_t k = 0; k < plane_count && outside; k++) {
        double taken = vec3d_dot(safe, planes[k].normal), room = planes[k].room - taken;
        double along = vec3d_dot(d, planes[k].normal) - taken;
        if (along > room)
            share = tl_min(share, tl_max(room, 0) / along);
    }
    if (vec3d_norm(d) > radius)
        share = tl_min(share, share_within(safe, d, radius));
    return share < 1 ? vec3d_mix(safe, d, share) : d;
}

bool tl_self_contact_allows(vec3d d, double radius, const struct tl_self_contact_plane *planes,
                            size_t plane_count)
{
    bool allowed = vec3d_norm(d) <= radius + ON_PLANE_M;
    for (size_t k = 0; k < plane_count && allowed; k++)
        allowed = vec3d_dot(d, planes[k].normal) <= planes[k].room + ON_PLANE_M;
    return allowed;
}
