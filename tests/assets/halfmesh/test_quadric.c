/* Quadrics against sums of squared distances; nearest points against the best of a fine grid of points. */
#include "tests/testing.h"

#include "assets/halfmesh/quadric.h"

#include <float.h>

/* A fixed sequence in [-1, 1]. */
static double next_number(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)*state / 2147483648.0 - 1;
}

static void next_point(uint32_t *state, double point[3])
{
    for (int c = 0; c < 3; c++)
        point[c] = next_number(state);
}

static double distance(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

static void quadrics_add_up_squared_distances(void **state)
{
    (void)state;
    uint32_t seed = 1;
    struct tl_quadric parts[2] = {{{0}}, {{0}}};
    double normals[8][3], points[8][3], weights[8], x[3], sum = 0;
    next_point(&seed, x);
    for (int i = 0; i < 8; i++) {
        next_point(&seed, normals[i]);
        next_point(&seed, points[i]);
        double length = distance(normals[i], (const double[3]){0, 0, 0}), off = 0;
        weights[i] = 1 + next_number(&seed);
        for (int c = 0; c < 3; c++) {
            normals[i][c] /= length;
            off += normals[i][c] * (x[c] - points[i][c]);
        }
        sum += weights[i] * off * off;
        tl_quadric_add_plane(&parts[i % 2], normals[i], points[i], weights[i]);
    }
    tl_quadric_add(&parts[0], &parts[1]);
    assert_near(tl_quadric_at(&parts[0], x), sum, 1e-12);
}

/* Points all around triangles, so that each corner, each side and the inside are nearest to some. */
static void the_nearest_point_is_nearest(void **state)
{
    (void)state;
    enum { STEPS = 200 };
    uint32_t seed = 7;
    for (int i = 0; i < 60; i++) {
        double triangle[3][3], x[3], weights[3], at[3] = {0, 0, 0}, best = DBL_MAX;
        for (int k = 0; k < 3; k++)
            next_point(&seed, triangle[k]);
        next_point(&seed, x);
        double found = sqrt(tl_triangle_nearest(x, (const double(*)[3])triangle, weights));
        for (int k = 0; k < 3; k++) {
            assert_true(weights[k] >= -1e-12 && weights[k] <= 1 + 1e-12);
            for (int c = 0; c < 3; c++)
                at[c] += weights[k] * triangle[k][c];
        }
        assert_near(distance(x, at), found, 1e-12);
        for (int v = 0; v <= STEPS; v++)
            for (int w = 0; v + w <= STEPS; w++) {
                double on[3];
                for (int c = 0; c < 3; c++)
                    on[c] =
                        ((STEPS - v - w) * triangle[0][c] + v * triangle[1][c] + w * triangle[2][c]) / STEPS;
                best = fmin(best, distance(x, on));
            }
        assert_true(found <= best + 1e-12);
        assert_near(found, best, 0.02); /* sides of up to 3.5 in 200 steps */
    }
}

static void segments_are_triangles_of_two_corners(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (int i = 0; i < 40; i++) {
        double ends[2][3], x[3], weights[3];
        next_point(&seed, ends[0]);
        next_point(&seed, ends[1]);
        next_point(&seed, x);
        const double flat[3][3] = {{ends[0][0], ends[0][1], ends[0][2]},
                                   {ends[1][0], ends[1][1], ends[1][2]},
                                   {ends[1][0], ends[1][1], ends[1][2]}};
        assert_near(tl_segment_distance(x, ends[0], ends[1]), sqrt(tl_triangle_nearest(x, flat, weights)),
                    1e-12);
    }
    const double point[3] = {1, 2, 2}, origin[3] = {0, 0, 0};
    assert_near(tl_segment_distance(point, origin, origin), 3, 1e-12);
}

static void shapes_go_from_a_line_to_equal_sides(void **state)
{
    (void)state;
    const double a[3] = {0, 0, 0}, b[3] = {1, 0, 0}, c[3] = {0.5, sqrt(0.75), 0}, d[3] = {2, 0, 0};
    assert_near(tl_triangle_shape(a, b, c, sqrt(0.75)), 1, 1e-12);
    assert_near(tl_triangle_shape(a, b, d, 0), 0, 1e-12);
    assert_near(tl_triangle_shape(a, a, a, 0), 0, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quadrics_add_up_squared_distances),
        cmocka_unit_test(the_nearest_point_is_nearest),
        cmocka_unit_test(segments_are_triangles_of_two_corners),
        cmocka_unit_test(shapes_go_from_a_line_to_equal_sides),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
