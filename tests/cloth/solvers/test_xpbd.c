/* XPBD, one substep at a time. Properties of all solvers are in test_closed_forms.c and test_conservation.c.
 */
#include "cloth/solvers/xpbd.h"
#include "cloth/state.h"
#include "cloth/timestep.h"
#include "tests/cloth/sheets.h"
#include "tests/testing.h"

#include "config/base/log.h"

static void predict(struct tl_particles *particles, double h)
{
    const struct tl_prediction prediction = tl_prediction_make(NULL, 0, 0, h);
    const struct tl_particle_kernel move = tl_prediction_kernel(particles, &prediction);
    tl_particles_run(&move);
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
        predict(&particles, h);
        tl_xpbd_solve_link(&link, &particles);
        tl_particles_finish(&particles, h);
        v = (v - h * k / m * stretch) / (1 + h * h * k / m);
        stretch += h * v;
        assert_near(particles.x[1].x - rest, stretch, 1e-12);
    }
    tl_particles_release(&particles);
}

/* A patch is sheared by a small angle in its plane. The derivative of its energy is the work of the corners'
 * forces. One XPBD substep from rest moves by the force times h^2 w as h goes to 0. */
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
    predict(p, h);
    tl_xpbd_solve(&cloth->energy, p, NULL);
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
        cmocka_unit_test(test_one_spring_is_implicit_euler),
        cmocka_unit_test(test_shear_force),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
