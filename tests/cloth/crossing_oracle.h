/* Brute force over all pairs of triangles whose heights overlap: whether they cross, by solving for the point
 * where each side meets the other triangle's plane. It shares no code with cloth/contact/crossings.c. */
#ifndef TOILE_TESTS_CLOTH_CROSSING_ORACLE_H
#define TOILE_TESTS_CLOTH_CROSSING_ORACLE_H

#include "cloth/mesh/topology.h"
#include "cloth/mesh/vec3d.h"

#include <stdbool.h>
#include <stdlib.h>

/* The intersection of [Moeller and Trumbore 1997]: the point p + t (q - p) = a + u (b - a) + v (c - a). */
static inline bool oracle_segment_meets(vec3d p, vec3d q, vec3d a, vec3d b, vec3d c)
{
    vec3d way = vec3d_sub(q, p), side = vec3d_sub(b, a), other = vec3d_sub(c, a), from = vec3d_sub(p, a);
    vec3d across = vec3d_cross(way, other);
    double determinant = vec3d_dot(side, across);
    if (determinant == 0)
        return false;
    double u = vec3d_dot(from, across) / determinant;
    vec3d turned = vec3d_cross(from, side);
    double v = vec3d_dot(way, turned) / determinant, t = vec3d_dot(other, turned) / determinant;
    return u > 0 && v > 0 && u + v < 1 && t > 0 && t < 1;
}

static inline bool oracle_touches(const uint32_t *a, const uint32_t *b, int a_count, int b_count)
{
    for (int i = 0; i < a_count; i++)
        for (int k = 0; k < b_count; k++)
            if (a[i] == b[k])
                return true;
    return false;
}

static inline bool oracle_sides_meet(const uint32_t *sides, const uint32_t *triangle, const vec3d *x)
{
    for (int i = 0; i < 3; i++) {
        const uint32_t ends[2] = {sides[i], sides[(i + 1) % 3]};
        if (!oracle_touches(ends, triangle, 2, 3) &&
            oracle_segment_meets(x[ends[0]], x[ends[1]], x[triangle[0]], x[triangle[1]], x[triangle[2]]))
            return true;
    }
    return false;
}

/* Whether the triangles' extents overlap on every axis: those of most pairs do not, which saves nearly all
 * time. */
static inline bool oracle_extents_meet(const uint32_t *a, const uint32_t *b, const vec3d *x)
{
    for (int axis = 0; axis < 3; axis++) {
        double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
        for (int i = 0; i < 6; i++) {
            const vec3d p = x[i < 3 ? a[i] : b[i - 3]];
            double at = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
            low[i / 3] = at < low[i / 3] ? at : low[i / 3];
            high[i / 3] = at > high[i / 3] ? at : high[i / 3];
        }
        if (low[0] > high[1] || low[1] > high[0])
            return false;
    }
    return true;
}

struct oracle_height {
    double low, high;
    const uint32_t *triangle;
};

static inline int oracle_compare(const void *a, const void *b)
{
    const double x = ((const struct oracle_height *)a)->low, y = ((const struct oracle_height *)b)->low;
    return (x > y) - (x < y);
}

/* Crossing pairs of triangles; positions are rounded to single precision first, as they are drawn. */
static inline size_t oracle_crossings(const struct tl_topology *topology, const vec3d *positions)
{
    const size_t triangle_count = topology->triangle_count;
    vec3d *x = TL_NEW_ARRAY(vec3d, topology->vertex_count);
    struct oracle_height *heights = TL_NEW_ARRAY(struct oracle_height, triangle_count);
    for (size_t i = 0; i < topology->vertex_count; i++)
        x[i] = vec3d_as_drawn(positions[i]);
    for (size_t i = 0; i < triangle_count; i++) {
        const uint32_t *v = topology->triangles[i];
        heights[i] = (struct oracle_height){fmin(x[v[0]].y, fmin(x[v[1]].y, x[v[2]].y)),
                                            fmax(x[v[0]].y, fmax(x[v[1]].y, x[v[2]].y)), v};
    }
    qsort(heights, triangle_count, sizeof *heights, oracle_compare);
    size_t count = 0;
    for (size_t i = 0; i < triangle_count; i++)
        for (size_t k = i + 1; k < triangle_count && heights[k].low <= heights[i].high; k++) {
            const uint32_t *a = heights[i].triangle, *b = heights[k].triangle;
            count +=
                oracle_extents_meet(a, b, x) && (oracle_sides_meet(a, b, x) || oracle_sides_meet(b, a, x));
        }
    free(heights);
    free(x);
    return count;
}

#endif
