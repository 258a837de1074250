#include "assets/halfmesh/quadric.h"

#include <math.h>
#include <stddef.h>

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = a[c] - b[c];
}

static double squared_distance(const double a[3], const double b[3])
{
    double between[3];
    subtract(a, b, between);
    return dot(between, between);
}

void tl_quadric_add_plane(struct tl_quadric *quadric, const double normal[3], const double point[3],
                          double weight)
{
    const double plane[4] = {normal[0], normal[1], normal[2], -dot(normal, point)};
    for (int row = 0, k = 0; row < 4; row++)
        for (int column = row; column < 4; column++)
            quadric->a[k++] += weight * plane[row] * plane[column];
}

void tl_quadric_add(struct tl_quadric *quadric, const struct tl_quadric *other)
{
    for (int k = 0; k < 10; k++)
        quadric->a[k] += other->a[k];
}

double tl_quadric_at(const struct tl_quadric *quadric, const double point[3])
{
    const double *a = quadric->a, x = point[0], y = point[1], z = point[2];
    return a[0] * x * x + a[4] * y * y + a[7] * z * z + a[9] +
           2 * (a[1] * x * y + a[2] * x * z + a[5] * y * z + a[3] * x + a[6] * y + a[8] * z);
}

double tl_triangle_shape(const double a[3], const double b[3], const double c[3], double twice_area)
{
    double sides = squared_distance(a, b) + squared_distance(b, c) + squared_distance(c, a);
    return sides > 0 ? 2 * sqrt(3) * twice_area / sides : 0;
}

double tl_triangle_nearest(const double point[3], const double triangle[3][3], double weights[3])
{
    double ab[3], ac[3], ax[3], bx[3], cx[3], v = 0, w = 0;
    subtract(triangle[1], triangle[0], ab);
    subtract(triangle[2], triangle[0], ac);
    subtract(point, triangle[0], ax);
    subtract(point, triangle[1], bx);
    subtract(point, triangle[2], cx);
    double d1 = dot(ab, ax), d2 = dot(ac, ax), d3 = dot(ab, bx), d4 = dot(ac, bx), d5 = dot(ab, cx),
           d6 = dot(ac, cx);
    double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (d1 <= 0 && d2 <= 0) { /* at the first corner */
    } else if (d3 >= 0 && d4 <= d3) {
        v = 1;
    } else if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        v = d1 / (d1 - d3);
    } else if (d6 >= 0 && d5 <= d6) {
        w = 1;
    } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        w = d2 / (d2 - d6);
    } else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        v = 1 - w;
    } else {
        v = vb / (va + vb + vc);
        w = vc / (va + vb + vc);
    }
    weights[0] = 1 - v - w;
    weights[1] = v;
    weights[2] = w;
    for (int c = 0; c < 3; c++)
        ax[c] -= v * ab[c] + w * ac[c];
    return dot(ax, ax);
}

double tl_segment_distance(const double point[3], const double from[3], const double to[3])
{
    double along[3], rest[3];
    subtract(to, from, along);
    subtract(point, from, rest);
    double squared = dot(along, along), at = squared > 0 ? dot(rest, along) / squared : 0;
    at = fmin(fmax(at, 0), 1);
    for (int c = 0; c < 3; c++)
        rest[c] -= at * along[c];
    return sqrt(dot(rest, rest));
}
