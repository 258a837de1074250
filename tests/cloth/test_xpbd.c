/* XPBD and its energy against closed forms. */
#include "cloth/state.h"
#include "sheets.h"
#include "testing.h"

#include "config/log.h"

static vec3s lay_flat(double u, double v)
{
    return (vec3s){{(float)u, 1, (float)-v}};
}

/* Every XPBD substep is y -= (v += g h) h, so n substeps fall g h^2 n(n+1)/2 = g/2 t(t+h) exactly. */
static void test_free_fall(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {8, 8, 0.2, 0.2};
    tl_garment garment = sheet_make(&shape, lay_flat);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    fabric.damping = 0;
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_non_null(cloth);
    double h = tl_cloth_substep(cloth);
    for (int frame = 1; frame <= 15; frame++) {
        assert_ok(tl_cloth_step(cloth, NULL, &error), error);
        double t = frame / params.frame_rate, fallen = 0.5 * params.gravity * t * (t + h);
        for (size_t i = 0; i < cloth->particles.count; i++)
            assert_near(1 - cloth->particles.x[i].y, fallen, 1e-9 * fallen);
    }
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* One spring, one substep at a time, is implicit Euler: v' = (v - h k/m e) / (1 + h^2 k/m). */
static void test_one_spring_is_implicit_euler(void **state)
{
    (void)state;
    const double k = 40, m = 0.01, rest = 0.5, h = 1.0 / 300;
    struct tl_particles particles = tl_particles_create(2);
    particles.w[0] = 0;
    particles.w[1] = 1 / m;
    particles.x[1].x = rest + 0.1;
    struct tl_link link = {0, 1, rest, 1 / (k * h * h)};
    double stretch = 0.1, v = 0;
    for (int i = 0; i < 1000; i++) {
        tl_xpbd_predict(&particles, 0, 0, h);
        tl_xpbd_solve_link(&link, &particles);
        tl_xpbd_finish(&particles, h);
        v = (v - h * k / m * stretch) / (1 + h * h * k / m);
        stretch += h * v;
        assert_near(particles.x[1].x - rest, stretch, 1e-12);
    }
    tl_particles_release(&particles);
}

/* A strip hanging from its upper edge stretches by u(s) = rho g (L s - s^2/2) / k; the discrete one lies
 * within its lumped end mass of that. Small strain: rho g L / k = 0.05 %. */
static void test_hanging_strip(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {2, 30, 0.04, 0.6};
    tl_garment garment = sheet_make(&shape, NULL);
    for (int column = 0; column <= shape.columns; column++)
        sheet_pin(&garment, sheet_vertex(&shape, column, shape.rows));
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    fabric.stretch_warp = 50; /* soft, so that substeps resolve the elements: see energy.h */
    fabric.damping = 20;
    params.substeps = 150;
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    assert_non_null(cloth);
    for (int frame = 0; frame < 60; frame++)
        assert_ok(tl_cloth_step(cloth, NULL, &error), error);
    double full =
        fabric.areal_density * params.gravity * shape.height * shape.height / (2 * fabric.stretch_warp);
    for (int row = 0; row <= shape.rows; row++) {
        double s = shape.height * (1 - (double)row / shape.rows), l = shape.height;
        double expected = fabric.areal_density * params.gravity * (l * s - s * s / 2) / fabric.stretch_warp;
        double y = 0;
        for (int column = 0; column <= shape.columns; column++)
            y += cloth->particles.x[sheet_vertex(&shape, column, row)].y / (shape.columns + 1);
        assert_near(shape.height - s - y, expected, 0.01 * full);
    }
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_fall),
        cmocka_unit_test(test_one_spring_is_implicit_euler),
        cmocka_unit_test(test_hanging_strip),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
