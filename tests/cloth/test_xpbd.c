/* XPBD and its energy against closed forms. */
#include "cloth/state.h"
#include "cloth/xpbd.h"
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
        tl_particles_predict(&particles, 0, 0, h);
        tl_xpbd_solve_link(&link, &particles);
        tl_particles_finish(&particles, h);
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

struct momenta {
    vec3d linear, angular;
    double size; /* sum of m |v| */
};

static struct momenta measure_momenta(const struct tl_particles *p)
{
    struct momenta sum = {0};
    for (size_t i = 0; i < p->count; i++) {
        double mass = 1 / p->w[i];
        sum.linear = vec3d_muladd(sum.linear, p->v[i], mass);
        sum.angular = vec3d_muladd(sum.angular, vec3d_cross(p->x[i], p->v[i]), mass);
        sum.size += mass * vec3d_norm(p->v[i]);
    }
    return sum;
}

/* Drift of the angular momentum over ten weightless, unpinned frames; that of the momentum is checked. */
static double angular_drift(int substeps)
{
    tl_error error = {0};
    const struct sheet_shape shape = {8, 8, 0.2, 0.2};
    tl_garment garment = sheet_make(&shape, lay_flat);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    fabric.damping = params.gravity = 0;
    params.substeps = substeps;
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    struct tl_particles *p = &cloth->particles;
    for (size_t i = 0; i < p->count; i++)
        p->v[i] = (vec3d){sin(7.0 * (double)i), cos(3.0 * (double)i), sin(2.0 * (double)i)};
    struct momenta before = measure_momenta(p);
    for (int frame = 0; frame < 10; frame++)
        assert_ok(tl_cloth_step(cloth, NULL, &error), error);
    struct momenta after = measure_momenta(p);
    /* Hundreds of substeps, each with a rounding of about 1e-16 x / h = 1e-13 m/s. */
    assert_near(vec3d_distance(before.linear, after.linear), 0, 1e-11 * before.size);
    double drift = vec3d_distance(before.angular, after.angular) / before.size;
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
    return drift;
}

/* Pushes act at predicted places and so keep the momentum exactly, the angular momentum to first order in h.
 */
static void test_momentum(void **state)
{
    (void)state;
    double coarse = angular_drift(20), fine = angular_drift(80);
    assert_true(coarse < 1e-3);
    assert_true(fine < coarse / 2);
}

/* A patch sheared by a small angle in its plane, nothing else: its energy's derivative is what the corners'
 * forces do. One XPBD substep from rest moves by the force times h^2 w as h goes to 0. */
static void test_shear_force(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {1, 1, 0.1, 0.1};
    tl_garment garment = sheet_make(&shape, NULL);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    fabric.damping = params.gravity = fabric.stretch_weft = fabric.stretch_warp = 0;
    fabric.bend_weft = fabric.bend_warp = 0;
    params.dt = 1e-5;
    params.frame_rate = 1000;
    params.substeps = 100;
    tl_cloth *cloth = tl_cloth_create(&garment, &fabric, &params, &error);
    const double angle = 0.01, h = tl_cloth_substep(cloth);
    struct tl_particles *p = &cloth->particles;
    for (size_t i = 0; i < p->count; i++)
        p->x[i].x += tan(angle) * p->x[i].y;
    double top = 0;
    tl_particles_predict(p, 0, 0, h);
    tl_xpbd_solve(&cloth->energy, p);
    tl_particles_finish(p, h);
    for (size_t i = 2; i < 4; i++)
        top += p->v[i].x / h / p->w[i];
    /* E = A/2 k sin^2(angle) for a top edge displaced by d = l tan(angle): F = -dE/dd. */
    double force = -0.1 * fabric.shear * sin(angle) * pow(cos(angle), 3);
    assert_near(top, force, 1e-3 * fabs(force));
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_fall),     cmocka_unit_test(test_one_spring_is_implicit_euler),
        cmocka_unit_test(test_hanging_strip), cmocka_unit_test(test_momentum),
        cmocka_unit_test(test_shear_force),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
