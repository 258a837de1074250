#include "cloth/self_contact/closest.h"

#include <float.h>

static double share(double part, double whole)
{
    return whole > 0 ? tl_min(tl_max(part / whole, 0), 1) : 0;
}

static double squared_distance_to(vec3d p, vec3d a, vec3d b, double *t)
{
    vec3d side = vec3d_sub(b, a);
    *t = share(vec3d_dot(vec3d_sub(p, a), side), vec3d_dot(side, side));
    vec3d away = vec3d_sub(p, vec3d_muladd(a, side, *t));
    return vec3d_dot(away, away);
}

/* The nearest point lies on a side: the nearest of the three sides' points. */
static void closest_on_sides(vec3d p, const vec3d corners[3], double weights[3])
{
    double best = HUGE_VAL;
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3;
        double t, squared = squared_distance_to(p, corners[i], corners[next], &t);
        if (!(squared < best))
            continue;
        best = squared;
        weights[i] = 1 - t;
        weights[next] = t;
        weights[(i + 2) % 3] = 0;
    }
}

void tl_closest_on_triangle(vec3d p, vec3d a, vec3d b, vec3d c, double weights[3])
{
    vec3d ab = vec3d_sub(b, a), ac = vec3d_sub(c, a), ap = vec3d_sub(p, a);
    double bb = vec3d_dot(ab, ab), bc = vec3d_dot(ab, ac), cc = vec3d_dot(ac, ac);
    double pb = vec3d_dot(ap, ab), pc = vec3d_dot(ap, ac);
    double area = bb * cc - bc * bc, v = cc * pb - bc * pc, w = bb * pc - bc * pb;
    if (area > 1e-12 * bb * cc && v >= 0 && w >= 0 && v + w <= area) {
        weights[1] = v / area;
        weights[2] = w / area;
        weights[0] = 1 - weights[1] - weights[2];
        return;
    }
    closest_on_sides(p, (const vec3d[3]){a, b, c}, weights);
}

void tl_closest_on_segments(vec3d p0, vec3d p1, vec3d q0, vec3d q1, double *s, double *t)
{
    vec3d d1 = vec3d_sub(p1, p0), d2 = vec3d_sub(q1, q0), r = vec3d_sub(p0, q0);
    double a = vec3d_dot(d1, d1), e = vec3d_dot(d2, d2), f = vec3d_dot(d2, r), c = vec3d_dot(d1, r),
           b = vec3d_dot(d1, d2), determinant = a * e - b * b;
    *s = determinant > 1e-12 * a * e ? share(b * f - c * e, determinant) : 0;
    *t = share(b * *s + f, e);
    *s = share(b * *t - c, a);
}

/* ---- Lanes ---- */

/* Single precision finds the nearest points of slender or parallel features only roughly: where the result is
 * ill-conditioned by a factor k, the place is off by k roundings of a side, and the distance differs by the
 * smaller of that and a side / k. Half of TL_CLOSEST_LOSS covers the worst, sqrt(2^-23) of a side, four
 * times.
 */
#define UNCERTAIN_SHARE (TL_CLOSEST_LOSS / 2)
/* Rounding of a squared distance and of its root. */
#define ROUND_SHARE 1e-6f

struct lane_vector {
    float x, y, z;
};

TL_INLINE struct lane_vector lane_of(const float point[3][TL_LANES], int lane)
{
    return (struct lane_vector){point[0][lane], point[1][lane], point[2][lane]};
}

TL_INLINE struct lane_vector lane_sub(struct lane_vector a, struct lane_vector b)
{
    return (struct lane_vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

TL_INLINE float lane_dot(struct lane_vector a, struct lane_vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* a + t d */
TL_INLINE struct lane_vector lane_along(struct lane_vector a, struct lane_vector d, float t)
{
    return (struct lane_vector){a.x + t * d.x, a.y + t * d.y, a.z + t * d.z};
}

/* share() without branches; a `whole` of 0 gives 0 or 1. */
TL_INLINE float lane_share(float part, float whole)
{
    return tl_minf(tl_maxf(part / tl_maxf(whole, FLT_MIN), 0), 1);
}

TL_INLINE float lane_bound(float squared, float longest_squared)
{
    return sqrtf(squared) * (1 - ROUND_SHARE) - UNCERTAIN_SHARE * sqrtf(longest_squared);
}

TL_CLONES void tl_closest_segment_bounds(const struct tl_closest_lanes *lanes, float bounds[TL_LANES])
{
    for (int i = 0; i < TL_LANES; i++) {
        struct lane_vector p = lane_of(lanes->point[0], i), q = lane_of(lanes->point[2], i);
        struct lane_vector d1 = lane_sub(lane_of(lanes->point[1], i), p),
                           d2 = lane_sub(lane_of(lanes->point[3], i), q), r = lane_sub(p, q);
        float a = lane_dot(d1, d1), e = lane_dot(d2, d2), f = lane_dot(d2, r), c = lane_dot(d1, r),
              b = lane_dot(d1, d2);
        float s = lane_share(b * f - c * e, a * e - b * b), t = lane_share(b * s + f, e);
        s = lane_share(b * t - c, a);
        struct lane_vector between = lane_sub(lane_along(p, d1, s), lane_along(q, d2, t));
        bounds[i] = lane_bound(lane_dot(between, between), tl_maxf(a, e));
    }
}

TL_INLINE float lane_side(struct lane_vector p, struct lane_vector a, struct lane_vector b, float *longest)
{
    struct lane_vector side = lane_sub(b, a), from = lane_sub(p, a);
    float squared = lane_dot(side, side), t = lane_share(lane_dot(from, side), squared);
    struct lane_vector away = lane_sub(p, lane_along(a, side, t));
    *longest = tl_maxf(*longest, squared);
    return lane_dot(away, away);
}

/* Above the inside of a triangle its plane is nearer than its sides. */
TL_CLONES void tl_closest_triangle_bounds(const struct tl_closest_lanes *lanes, float bounds[TL_LANES])
{
    for (int i = 0; i < TL_LANES; i++) {
        struct lane_vector p = lane_of(lanes->point[0], i), a = lane_of(lanes->point[1], i),
                           b = lane_of(lanes->point[2], i), c = lane_of(lanes->point[3], i);
        struct lane_vector ab = lane_sub(b, a), ac = lane_sub(c, a), ap = lane_sub(p, a);
        float bb = lane_dot(ab, ab), bc = lane_dot(ab, ac), cc = lane_dot(ac, ac);
        float pb = lane_dot(ap, ab), pc = lane_dot(ap, ac), longest = 0;
        float area = bb * cc - bc * bc, v = cc * pb - bc * pc, w = bb * pc - bc * pb;
        float per = 1 / tl_maxf(area, FLT_MIN);
        struct lane_vector away = lane_sub(lane_along(lane_along(a, ab, v * per), ac, w * per), p);
        float inside = ((v >= 0) & (w >= 0) & (v + w <= area)) ? lane_dot(away, away) : FLT_MAX;
        float sides = tl_minf(tl_minf(lane_side(p, a, b, &longest), lane_side(p, b, c, &longest)),
                              lane_side(p, c, a, &longest));
        bounds[i] = lane_bound(tl_minf(inside, sides), longest);
    }
}
