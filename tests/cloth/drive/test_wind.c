/* Wind against closed forms: the fall of a flat sheet and the force on a held one; and a flag in the wind. */
#include "cloth/drive/wind.h"
#include "cloth/measure.h"
#include "cloth/state.h"
#include "tests/cloth/sheets.h"
#include "tests/cloth/solvers.h"
#include "tests/testing.h"

#include "config/base/log.h"

static vec3s lying(double u, double v)
{
    return (vec3s){{(float)u, 100, (float)-v}};
}

/* v = v_t tanh(g t / v_t), v_t = sqrt(2 g areal density / rho). The air moves at the smallest speed that the
 * option allows: the force depends on the speed relative to it. */
static void test_terminal_velocity(void **state)
{
    (void)state;
    tl_error error = {0};
    const double densities[] = {0.05, 0.15, 0.5}, still = 1e-6;
    for (size_t d = 0; d < TL_COUNT(densities); d++)
        for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++) {
            const struct sheet_shape shape = {6, 6, 0.3, 0.3};
            tl_garment garment = sheet_make(&shape, lying);
            struct tl_cloth_fabric fabric = fabric_defaults();
            struct tl_cloth_params params = params_defaults();
            fabric.areal_density = densities[d];
            fabric.damping = 0;
            params.solver = solver;
            params.dt = 1.0 / 600;
            params.substeps = 4;
            params.wind[0] = (float)still;
            tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
            assert_non_null(cloth);
            double terminal = sqrt(2 * params.gravity * fabric.areal_density / TL_AIR_DENSITY);
            for (int frame = 1; frame <= 30; frame++) {
                assert_ok(tl_cloth_step(cloth, NULL, &error), error);
                double expected = terminal * tanh(params.gravity * frame / params.frame_rate / terminal);
                /* The error is of first order in the step: at most 2 g h / v_t, relative to the speed. */
                for (size_t i = 0; i < cloth->particles.count; i++)
                    assert_near(-cloth->particles.v[i].y, expected, 0.02 * terminal);
            }
            assert_near(-cloth->particles.v[0].y, terminal, 0.005 * terminal);
            tl_cloth_destroy(&cloth);
            sheet_free(&garment);
        }
}

/* The forces on a sheet across the wind sum to 1/2 rho A v^2 along its normal, times cos^2 if it is tilted.
 */
static void test_pressure(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {5, 4, 0.5, 0.4};
    tl_garment garment = sheet_make(&shape, NULL);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    vec3d *forces = TL_NEW_ARRAY(vec3d, cloth->particles.count);
    for (int tilt = 0; tilt < 4; tilt++) {
        const double angle = 0.5 * tilt, speed = 8;
        const struct tl_wind wind = {.velocity = {speed * sin(angle), 0, -speed * cos(angle)},
                                     .areal_density = 0.15};
        tl_wind_forces(&wind, &cloth->topology, 1e-3, &cloth->particles, forces);
        vec3d sum = {0};
        for (size_t i = 0; i < cloth->particles.count; i++)
            sum = vec3d_add(sum, forces[i]);
        double across = speed * cos(angle), expected = -0.5 * TL_AIR_DENSITY * 0.2 * across * across;
        assert_near(sum.z, expected, 1e-6);
        assert_near(sum.x, 0, 1e-12);
    }
    free(forces);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* Gusts stay within their share, have zero mean and travel with the wind. */
static void test_gusts(void **state)
{
    (void)state;
    struct tl_wind wind = {.velocity = {3, 0, 4}, .gust = 0.4, .areal_density = 0.1};
    double sum = 0, min_speed = HUGE_VAL, max_speed = 0;
    const int count = 20000;
    for (int i = 0; i < count; i++) {
        wind.time_s = 0.05 * i;
        double speed = vec3d_norm(tl_wind_at(&wind, (vec3d){0}));
        sum += speed / count;
        min_speed = fmin(min_speed, speed);
        max_speed = fmax(max_speed, speed);
    }
    assert_true(min_speed > 3 && min_speed < 3.6 && max_speed < 7 && max_speed > 6.4);
    assert_near(sum, 5, 0.01);
    wind.time_s = 2;
    vec3d here = tl_wind_at(&wind, (vec3d){0.3, 0.1, 0.4}); /* 0.5 m down the wind: 0.1 s later */
    wind.time_s = 1.9;
    assert_near(vec3d_distance(here, tl_wind_at(&wind, (vec3d){0})), 0, 1e-12);
}

/* The forces on all vertices are those of the exact wind at the triangles' middles, which takes the gusts
 * from a table where that is shorter than the cloth (here at 2 and 20 m/s, not at 0.05). The wind is off by
 * 2e-5 of the gusts, so pressure by twice that. */
static void test_gusts_on_cloth(void **state)
{
    (void)state;
    const double h = 1e-4, off = 5e-5, speeds[] = {0.05, 2, 20};
    const struct sheet_shape shape = {24, 20, 1.2, 1};
    tl_garment garment = sheet_make(&shape, NULL);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    const struct tl_particles *particles = &cloth->particles;
    vec3d *forces = TL_NEW_ARRAY(vec3d, particles->count), *expected = TL_NEW_ARRAY(vec3d, particles->count);
    for (int k = 0; k < 60; k++) {
        double speed = speeds[k % 3], maximum = 0;
        const struct tl_wind wind = {
            .velocity = {0.6 * speed, 0, -0.8 * speed}, .gust = 1, .time_s = 0.37 * k, .areal_density = 10};
        memset(expected, 0, particles->count * sizeof *expected);
        for (size_t t = 0; t < cloth->topology.triangle_count; t++) {
            const uint32_t *v = cloth->topology.triangles[t];
            const vec3d *x = particles->x;
            vec3d area = vec3d_cross(vec3d_sub(x[v[1]], x[v[0]]), vec3d_sub(x[v[2]], x[v[0]]));
            vec3d middle = vec3d_scale(vec3d_add(vec3d_add(x[v[0]], x[v[1]]), x[v[2]]), 1.0 / 3);
            double against = vec3d_dot(area, tl_wind_at(&wind, middle)) / vec3d_norm(area);
            for (int i = 0; i < 3; i++)
                expected[v[i]] =
                    vec3d_muladd(expected[v[i]], area, TL_AIR_DENSITY * fabs(against) * against / 12);
        }
        tl_wind_forces(&wind, &cloth->topology, h, particles, forces);
        for (size_t i = 0; i < particles->count; i++)
            maximum = fmax(maximum, vec3d_distance(forces[i], expected[i]));
        /* 1/2 rho A (2 v)^2 is the most that a vertex's six thirds of triangles can bear */
        assert_true(maximum < off * TL_AIR_DENSITY * 2 * (0.05 * 0.05) * 4 * speed * speed);
    }
    free(forces);
    free(expected);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* A flag held along one side: it streams downwind and flutters. Its mean slope follows from weight against
 * pressure: the slower the wind, the steeper. */
static double fly(double speed, double *flutter)
{
    tl_error error = {0};
    const struct sheet_shape shape = {24, 16, 0.6, 0.4};
    tl_garment garment = sheet_make(&shape, NULL);
    for (int row = 0; row <= shape.rows; row++)
        sheet_pin(&garment, sheet_vertex(&shape, 0, row));
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    fabric.areal_density = 0.05;
    params.wind[0] = (float)speed;
    params.wind[2] =
        (float)(0.15 * speed); /* slightly from the side: a flat flag exactly along the wind has no force */
    params.gust = 0.3;
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    double reach = 0;
    *flutter = 0;
    for (int frame = 0; frame < 180; frame++) {
        assert_ok(tl_cloth_step(cloth, NULL, &error), error);
        vec3d tip = cloth->particles.x[sheet_vertex(&shape, shape.columns, shape.rows / 2)];
        assert_true(tl_cloth_max_strain(cloth) < 0.5);
        if (frame >= 60) {
            reach += tip.x / 120;
            *flutter = fmax(*flutter, fabs(tip.z));
        }
    }
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
    return reach;
}

static void test_flag(void **state)
{
    (void)state;
    double flutter[2], calm = fly(1, &flutter[0]), windy = fly(9, &flutter[1]);
    printf("flag: reaches %.2f m at 1 m/s, %.2f m at 9 m/s, swings by %.3f and %.3f m\n", calm, windy,
           flutter[0], flutter[1]);
    assert_true(windy > 0.45 && windy < 0.6);
    assert_true(calm < 0.75 * windy);
    assert_true(flutter[1] > 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_terminal_velocity),
        cmocka_unit_test(test_pressure),
        cmocka_unit_test(test_gusts),
        cmocka_unit_test(test_gusts_on_cloth),
        cmocka_unit_test(test_flag),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
