/* Signed distances against closed forms. */
#include "cloth/contact/collider.h"
#include "cloth/mesh/vec3d.h"
#include "tests/cloth/bodies.h"
#include "tests/testing.h"

static double halton(uint32_t index, uint32_t base)
{
    double value = 0, share = 1;
    for (; index > 0; index /= base) {
        share /= base;
        value += share * (index % base);
    }
    return value;
}

/* Signed distance to an axis-aligned box: outside the length of the excess, inside the nearest face. */
static double box_distance(vec3d p, vec3d half)
{
    vec3d q = {fabs(p.x) - half.x, fabs(p.y) - half.y, fabs(p.z) - half.z};
    vec3d out = {fmax(q.x, 0), fmax(q.y, 0), fmax(q.z, 0)};
    return vec3d_norm(out) + fmin(fmax(q.x, fmax(q.y, q.z)), 0);
}

/* Distances at faces, edges and corners from both sides. The gradient has length 1 in the direction of the
 * normal. */
static void test_box(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_mesh mesh = body_box((vec3s){{0, 0, 0}}, (vec3s){{0.5f, 0.25f, 0.125f}}, 0);
    const vec3d half = {0.5, 0.25, 0.125};
    tl_collider *collider = tl_collider_create(&mesh, false, &error);
    assert_non_null(collider);
    for (uint32_t i = 1; i <= 4000; i++) {
        const double p[3] = {2 * halton(i, 2) - 1, 2 * halton(i, 3) - 1, 2 * halton(i, 5) - 1};
        struct tl_contact contact;
        vec3d at = {p[0], p[1], p[2]};
        double distance = box_distance(at, half);
        assert_true(tl_collider_query(collider, p, 2, &contact));
        assert_near(contact.distance_m, distance, 1e-12);
        vec3d normal = {contact.normal[0], contact.normal[1], contact.normal[2]};
        assert_near(vec3d_norm(normal), 1, 1e-9);
        double step =
            1e-4; /* along the normal the distance grows by the displacement, unless a ridge is near */
        if (distance > 0)
            assert_near(box_distance(vec3d_muladd(at, normal, step), half), distance + step, 1e-9);
    }
    tl_collider_destroy(&collider);
    tl_mesh_release(&mesh);
}

/* A sphere of n rings lies between its radius and the radius times cos^2(pi/2n). */
static void test_sphere_inside_and_out(void **state)
{
    (void)state;
    tl_error error = {0};
    const double radius = 0.5;
    const int rings = 64;
    tl_mesh mesh = body_sphere((vec3s){{0, 1, 0}}, radius, rings);
    tl_collider *collider = tl_collider_create(&mesh, false, &error);
    assert_non_null(collider);
    double sag = radius * (1 - pow(cos(M_PI / (2 * rings)), 2));
    for (uint32_t i = 1; i <= 4000; i++) {
        const double p[3] = {2 * halton(i, 2) - 1, 2 * halton(i, 3), 2 * halton(i, 5) - 1};
        struct tl_contact contact;
        double distance = sqrt(p[0] * p[0] + (p[1] - 1) * (p[1] - 1) + p[2] * p[2]) - radius;
        assert_true(tl_collider_query(collider, p, 3, &contact));
        assert_near(contact.distance_m, distance + sag / 2, sag / 2 + 1e-6);
    }
    tl_collider_destroy(&collider);
    tl_mesh_release(&mesh);
}

/* The winding number is 1 inside and 0 outside to rounding, also near faces, edges and corners. */
static void test_winding(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_mesh mesh = body_box((vec3s){{0, 0, 0}}, (vec3s){{0.5f, 0.25f, 0.125f}}, 0);
    const vec3d half = {0.5, 0.25, 0.125};
    tl_collider *collider = tl_collider_create(&mesh, false, &error);
    assert_non_null(collider);
    for (uint32_t i = 1; i <= 4000; i++) {
        const double p[3] = {2 * halton(i, 2) - 1, 2 * halton(i, 3) - 1, 2 * halton(i, 5) - 1};
        assert_near(tl_collider_winding(collider, p), box_distance((vec3d){p[0], p[1], p[2]}, half) < 0,
                    1e-12);
    }
    const double within = 0.125 - 1e-9, beyond = 0.125 + 1e-9;
    assert_near(tl_collider_winding(collider, (const double[3]){0.3, 0.1, within}), 1, 1e-6);
    assert_near(tl_collider_winding(collider, (const double[3]){0.3, 0.1, beyond}), 0, 1e-6);
    tl_collider_destroy(&collider);
    tl_mesh_release(&mesh);
}

/* The top of a box is pushed 0.2 m below its bottom, so the box is inside out. A point above the bottom is
 * nearest to the bottom's back, at a negative distance, and is outside. Between the two faces the winding
 * number is -1. */
static void test_inside_out_is_not_inside(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_mesh mesh = body_box((vec3s){{0, 0, 0}}, (vec3s){{0.5f, 0.25f, 0.5f}}, 0);
    tl_collider *collider = tl_collider_create(&mesh, false, &error);
    vec3s folded[8];
    for (int i = 0; i < 8; i++) {
        folded[i] = mesh.positions[i];
        folded[i].y = i & 2 ? -0.45f : -0.25f;
    }
    tl_collider_move(collider, folded);
    const double above[3] = {0.1, -0.2, 0.1}, between[3] = {0.1, -0.35, 0.1};
    struct tl_contact contact;
    assert_true(tl_collider_query(collider, above, 1, &contact));
    assert_near(contact.distance_m, -0.05, 1e-7);
    assert_near(tl_collider_winding(collider, above), 0, 1e-12);
    assert_near(tl_collider_winding(collider, between), -1, 1e-12);
    tl_collider_destroy(&collider);
    tl_mesh_release(&mesh);
}

static void test_reach_and_nothing(void **state)
{
    (void)state;
    tl_error error = {0};
    const double p[3] = {0, 0, 0.525};
    struct tl_contact contact;
    tl_collider *ground = tl_collider_create(NULL, true, &error);
    assert_false(tl_collider_query(ground, p, 10, &contact));
    assert_true(tl_collider_has_ground(ground));
    tl_collider_destroy(&ground);
    tl_mesh mesh = body_box((vec3s){{0, 0, 0}}, (vec3s){{0.5f, 0.5f, 0.5f}}, 0);
    tl_collider *collider = tl_collider_create(&mesh, false, &error);
    assert_false(tl_collider_query(collider, p, 0.024, &contact));
    assert_true(tl_collider_query(collider, p, 0.026, &contact));
    tl_collider_destroy(&collider);
    tl_mesh_release(&mesh);
}

/* During a move the surface is interpolated between both poses. A second move to the same positions brings it
 * to rest. */
static void test_moving(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_mesh mesh = body_box((vec3s){{0, 0, 0}}, (vec3s){{0.5f, 0.5f, 0.5f}}, 0);
    tl_collider *collider = tl_collider_create(&mesh, false, &error);
    vec3s moved[8];
    for (int i = 0; i < 8; i++)
        moved[i] = (vec3s){{mesh.positions[i].x + 0.25f, mesh.positions[i].y, mesh.positions[i].z}};
    tl_collider_move(collider, moved);
    assert_near(tl_collider_travel(collider), 0.25, 1e-12);
    const double p[3] = {1, 0.1, 0.1};
    struct tl_contact contact;
    for (int i = 0; i <= 8; i++) {
        double phase = i / 8.0;
        assert_true(tl_collider_query_at(collider, p, phase, 1, &contact));
        assert_near(contact.distance_m, 0.5 - 0.25 * phase, 1e-12);
        double before[3], after[3];
        tl_collider_path(collider, contact.triangle, contact.barycentric, before, after);
        assert_near(after[0] - before[0], 0.25, 1e-12);
    }
    uint64_t revision = tl_collider_revision(collider);
    tl_collider_move(collider, moved);
    assert_true(tl_collider_revision(collider) > revision);
    assert_near(tl_collider_travel(collider), 0, 0);
    revision = tl_collider_revision(collider);
    tl_collider_move(collider, moved);
    assert_int_equal(tl_collider_revision(collider), revision);
    assert_true(tl_collider_query_at(collider, p, 0, 1, &contact));
    assert_near(contact.distance_m, 0.25, 1e-12);
    tl_collider_destroy(&collider);
    tl_mesh_release(&mesh);
}

static void test_bad_vertices_are_refused(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_mesh mesh = body_box((vec3s){{0, 0, 0}}, (vec3s){{1, 1, 1}}, 0);
    mesh.positions[3].y = NAN;
    assert_null(tl_collider_create(&mesh, false, &error));
    assert_int_equal(error.code, TL_INPUT);
    tl_mesh_release(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_sphere_inside_and_out),
        cmocka_unit_test(test_winding),
        cmocka_unit_test(test_inside_out_is_not_inside),
        cmocka_unit_test(test_reach_and_nothing),
        cmocka_unit_test(test_moving),
        cmocka_unit_test(test_bad_vertices_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
