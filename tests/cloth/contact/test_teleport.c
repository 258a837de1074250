/* Avatars that jump: the cloth moves with them, stays worn and outside. Also the rigid fit that moves the
 * cloth. */
#include "cloth/mesh/rigid.h"
#include "cloth/state.h"
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "config/base/log.h"

/* Turns p about an axis and translates it. */
static vec3d moved_by(vec3d p, double angle, vec3d by)
{
    return (vec3d){cos(angle) * p.x + sin(angle) * p.z + by.x, p.y + by.y,
                   cos(angle) * p.z - sin(angle) * p.x + by.z};
}

/* The fit of a rigid motion is that motion, also for half a turn and for a flat set of points, which a
 * reflection would fit as well. */
static void test_rigid_fit(void **state)
{
    (void)state;
    const double angles[] = {0, 0.3, M_PI / 2, M_PI, -3};
    for (int flat = 0; flat < 2; flat++)
        for (size_t a = 0; a < TL_COUNT(angles); a++) {
            enum { COUNT = 40 };
            vec3s from[COUNT], to[COUNT];
            const vec3d by = {10, -1, 3};
            for (int i = 0; i < COUNT; i++) {
                vec3d p = {sin(i), flat ? 0 : cos(3.0 * i), sin(7.0 * i + 1)};
                from[i] = vec3d_to_float(p);
                to[i] = vec3d_to_float(moved_by(vec3d_from(from[i]), angles[a], by));
            }
            struct tl_rigid rigid = tl_rigid_fit(from, to, COUNT);
            vec3d probe = {0.3, 0.2, -0.5};
            double error = vec3d_distance(tl_rigid_point(&rigid, probe), moved_by(probe, angles[a], by));
            assert_near(error, 0, 5e-6); /* rounding of float coordinates 10 m from the origin */
            vec3d turned = tl_rigid_turn(&rigid, probe);
            assert_near(vec3d_distance(turned, moved_by(probe, angles[a], (vec3d){0})), 0, 2e-6);
        }
    struct tl_rigid nothing = tl_rigid_fit(NULL, NULL, 0);
    assert_near(vec3d_distance(tl_rigid_point(&nothing, (vec3d){1, 2, 3}), (vec3d){1, 2, 3}), 0, 1e-15);
}

static vec3s above(double u, double v)
{
    return (vec3s){{(float)(u - 0.25), 0.71f, (float)(0.25 - v)}};
}

/* A cloth lies on a sphere that jumps within one frame and stays there. */
static void jump(double angle, vec3d by, float scale)
{
    tl_error error = {0};
    const struct sheet_shape shape = {24, 24, 0.5, 0.5};
    tl_garment garment = sheet_make(&shape, above);
    tl_mesh sphere = body_sphere((vec3s){{0, 0.5f, 0}}, 0.2, 24);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_collider *collider = tl_collider_create(&sphere, true, &error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_ok(tl_cloth_settle(cloth, collider, &error), error);
    vec3d marked = moved_by(cloth->particles.x[100], angle, by);
    for (size_t i = 0; i < sphere.vertex_count; i++) {
        vec3d p = vec3d_from(sphere.positions[i]);
        p = (vec3d){p.x * (double)scale, 0.5 + (p.y - 0.5) * (double)scale, p.z * (double)scale};
        sphere.positions[i] = vec3d_to_float(moved_by(p, angle, by));
    }
    for (int frame = 0; frame < 30; frame++) {
        tl_collider_move(collider, sphere.positions);
        assert_ok(tl_cloth_step(cloth, collider, &error), error);
        struct tl_cloth_report report = tl_cloth_measure(cloth, collider);
        assert_near(report.deepest_m, 0, 1e-6);
        assert_true(report.max_strain < 0.5);
        assert_true(report.max_speed <
                    (scale == 1 ? 1 : 3)); /* 1 cm in 33 ms, and the velocity that contact adds */
    }
    assert_near(vec3d_distance(cloth->particles.x[100], marked), 0, 0.02 + 0.3 * fabs((double)scale - 1));
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&sphere);
    sheet_free(&garment);
}

static void test_ten_metres(void **state)
{
    (void)state;
    jump(0, (vec3d){10, 0, 0}, 1);
}

static void test_half_turn(void **state)
{
    (void)state;
    jump(M_PI, (vec3d){0.6, 0, 0}, 1);
}

/* A sphere that grows by 5 % within a frame does not count as a jump; it pushes the cloth out. */
static void test_growing(void **state)
{
    (void)state;
    jump(0, (vec3d){0}, 1.05f);
}

/* A cloth that is pinned in the world does not follow. */
static void test_flag_stays(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {8, 8, 0.2, 0.2};
    tl_garment garment = sheet_make(&shape, above);
    tl_mesh sphere = body_sphere((vec3s){{3, 0.5f, 0}}, 0.2, 12);
    sheet_pin(&garment, 0);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_collider *collider = tl_collider_create(&sphere, false, &error);
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_ok(tl_cloth_step(cloth, collider, &error), error);
    for (size_t i = 0; i < sphere.vertex_count; i++)
        sphere.positions[i].x += 5;
    tl_collider_move(collider, sphere.positions);
    assert_ok(tl_cloth_step(cloth, collider, &error), error);
    for (size_t i = 0; i < cloth->particles.count; i++)
        assert_true(cloth->particles.x[i].x < 0.5);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&sphere);
    sheet_free(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rigid_fit), cmocka_unit_test(test_ten_metres), cmocka_unit_test(test_half_turn),
        cmocka_unit_test(test_growing),   cmocka_unit_test(test_flag_stays),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
