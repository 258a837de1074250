#include "cloth/contact/closest.h"

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
