/* Flat pieces: Delaunay's empty circles by brute force, areas against closed forms, outlines kept, angles. */
#include "tests/testing.h"

#include "assets/sewing/delaunay.h"
#include "assets/sewing/panel.h"

#include "config/base/memory.h"

static double area_of(const struct tl_point *p, const uint32_t t[3])
{
    return 0.5 * ((p[t[1]].x - p[t[0]].x) * (p[t[2]].y - p[t[0]].y) -
                  (p[t[2]].x - p[t[0]].x) * (p[t[1]].y - p[t[0]].y));
}

/* The in-circle determinant: positive when d is inside the circle through the counter-clockwise triangle. */
static double in_circle(const struct tl_point *p, const uint32_t t[3], uint32_t d)
{
    double m[3][3];
    for (int i = 0; i < 3; i++) {
        m[i][0] = p[t[i]].x - p[d].x;
        m[i][1] = p[t[i]].y - p[d].y;
        m[i][2] = m[i][0] * m[i][0] + m[i][1] * m[i][1];
    }
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* 300 points of a low-discrepancy sequence (R2: multiples of 1/g, 1/g^2, g = 1.3247..., modulo 1): every
 * triangle counter-clockwise with no fourth point in its circle, together the convex hull's area. */
static void test_delaunay(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    struct tl_point points[COUNT + 4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < COUNT; i++)
        points[4 + i] = (struct tl_point){fmod(0.5 + 0.7548776662 * i, 1), fmod(0.5 + 0.5698402910 * i, 1)};
    uint32_t(*triangles)[3];
    size_t count = tl_delaunay(points, COUNT + 4, &triangles);
    double area = 0;
    for (size_t t = 0; t < count; t++) {
        area += area_of(points, triangles[t]);
        assert_true(area_of(points, triangles[t]) > 0);
        for (uint32_t d = 0; d < COUNT + 4; d++)
            assert_true(in_circle(points, triangles[t], d) < 1e-12);
    }
    assert_near(area, 1, 1e-12);
    assert_int_equal(count, 2 * (COUNT + 4) - 4 - 2); /* Euler, with a hull of four points */
    free(triangles);
}

static double smallest_angle(const tl_panel_mesh *panel)
{
    double smallest = M_PI;
    for (size_t t = 0; t < panel->triangle_count; t++) {
        for (int k = 0; k < 3; k++) {
            struct tl_point a = panel->points[panel->triangles[t][k]];
            struct tl_point b = panel->points[panel->triangles[t][(k + 1) % 3]];
            struct tl_point c = panel->points[panel->triangles[t][(k + 2) % 3]];
            double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
            smallest = fmin(smallest, atan2(ux * vy - uy * vx, ux * vx + uy * vy));
        }
    }
    return smallest * 180 / M_PI;
}

static double panel_area(const tl_panel_mesh *panel)
{
    double area = 0;
    for (size_t t = 0; t < panel->triangle_count; t++) {
        assert_true(area_of(panel->points, panel->triangles[t]) > 0);
        area += area_of(panel->points, panel->triangles[t]);
    }
    return area;
}

/* A rectangle is covered exactly, its corners are points, its sides evenly divided. */
static void test_rectangle(void **state)
{
    (void)state;
    const struct tl_point corners[4] = {{0, 0}, {0.5, 0}, {0.5, 0.3}, {0, 0.3}};
    const int segments[4] = {25, 15, 25, 15};
    struct tl_curve outline[4];
    for (int i = 0; i < 4; i++) {
        outline[i] = tl_curve_line(corners[i], corners[(i + 1) % 4]);
        outline[i].segments = segments[i];
        assert_near(tl_curve_length(&outline[i]), i % 2 ? 0.3 : 0.5, 1e-12);
    }
    tl_panel_mesh panel = tl_panel_cut(outline, 4, 0.02);
    assert_near(panel_area(&panel), 0.15, 1e-12);
    assert_int_equal(panel.outline_count, 80);
    assert_near(panel.points[25].x, 0.5, 1e-12);
    assert_near(panel.points[26].y, 0.02, 1e-9);
    assert_true(smallest_angle(&panel) > 25);
    tl_panel_release(&panel);
    assert_null(panel.points);
}

/* A disc of four quarter arcs: its area is the regular polygon's of as many sides, n/2 sin(2 pi/n), within
 * the cubics' error (0.03 % of the radius). */
static void test_disc(void **state)
{
    (void)state;
    const double k = 4.0 / 3 * (sqrt(2) - 1);
    struct tl_curve outline[4];
    for (int i = 0; i < 4; i++) {
        double c = cos(i * M_PI / 2), s = sin(i * M_PI / 2);
        outline[i] = (struct tl_curve){
            .control = {{c, s}, {c - k * s, s + k * c}, {-s + k * c, c + k * s}, {-s, c}}, .segments = 20};
        assert_near(tl_curve_length(&outline[i]), M_PI / 2, 1e-3);
    }
    tl_panel_mesh panel = tl_panel_cut(outline, 4, M_PI / 40);
    assert_near(panel_area(&panel), 40 * sin(2 * M_PI / 80), 1e-3);
    assert_true(smallest_angle(&panel) > 25);
    for (size_t i = 0; i < panel.outline_count; i++)
        assert_near(hypot(panel.points[i].x, panel.points[i].y), 1, 3e-4);
    tl_panel_release(&panel);
}

/* A slit 4 mm wide, the points on its sides opposite the middles of the other side's edges: those edges are
 * no Delaunay edges. They are kept all the same, and the triangles cover what the slit leaves, no more. */
static void test_slit(void **state)
{
    (void)state;
    struct tl_point outline[64];
    size_t count = 0;
    for (int i = 0; i < 10; i++)
        outline[count++] = (struct tl_point){0.02 * i, 0};
    for (int i = 0; i < 10; i++)
        outline[count++] = (struct tl_point){0.2, 0.02 * i};
    for (int i = 0; i < 5; i++)
        outline[count++] = (struct tl_point){0.2 - 0.0196 * i, 0.2};
    for (int i = 0; i < 8; i++)
        outline[count++] = (struct tl_point){0.102, 0.2 - 0.02 * i};
    for (int i = 0; i < 8; i++)
        outline[count++] = (struct tl_point){0.098, 0.05 + 0.02 * i};
    for (int i = 0; i < 5; i++)
        outline[count++] = (struct tl_point){0.098 - 0.0196 * i, 0.2};
    for (int i = 0; i < 10; i++)
        outline[count++] = (struct tl_point){0, 0.2 - 0.02 * i};
    double exact = 0, area = 0;
    for (size_t i = 0; i < count; i++) {
        struct tl_point a = outline[i], b = outline[(i + 1) % count];
        exact += 0.5 * (a.x * b.y - b.x * a.y);
    }
    tl_panel_mesh panel;
    assert_true(tl_panel_fill(outline, count, 0.02, &panel));
    for (size_t t = 0; t < panel.triangle_count; t++) {
        assert_true(area_of(panel.points, panel.triangles[t]) > 0);
        area += area_of(panel.points, panel.triangles[t]);
    }
    assert_near(area, exact, 1e-9);
    tl_panel_release(&panel);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_delaunay),
        cmocka_unit_test(test_rectangle),
        cmocka_unit_test(test_disc),
        cmocka_unit_test(test_slit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
