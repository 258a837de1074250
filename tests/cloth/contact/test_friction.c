/* Coulomb friction under every solver: a sheet on an incline, a strip pulled over a cylinder. */
#include "tests/cloth/bodies.h"
#include "tests/cloth/solvers.h"

#include "cloth/measure.h"
#include "config/base/log.h"

static const double thickness_m = 0.003;

/* ---- Incline: sticks iff tan(theta) <= mu, else a = g (sin - mu cos) ---- */

struct slope {
    double tilt, friction;
};
static double tilt_now; /* read by place_on_slope, which takes no more arguments */

/* On the plane through the origin that falls to +x, at the distance that contact keeps. */
static vec3s place_on_slope(double u, double v)
{
    double along = u - 0.1, out = thickness_m;
    return (vec3s){{(float)(cos(tilt_now) * along + sin(tilt_now) * out),
                    (float)(-sin(tilt_now) * along + cos(tilt_now) * out), (float)(0.1 - v)}};
}

/* Displacement of the middle of a sheet down a slope after `seconds`, and its velocity then. */
struct slid {
    double distance, speed;
};

static struct slid slide(const struct slope *slope, int solver, double seconds)
{
    tl_error error = {0};
    tilt_now = slope->tilt;
    const struct sheet_shape shape = {10, 10, 0.2, 0.2};
    tl_garment garment = sheet_make(&shape, place_on_slope);
    vec3s below = {{(float)(-sin(tilt_now) * 0.5), (float)(-cos(tilt_now) * 0.5), 0}};
    tl_mesh box = body_box(below, (vec3s){{4, 0.5f, 4}}, -tilt_now);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_exact(solver);
    fabric.friction = slope->friction;
    fabric.thickness_m = thickness_m;
    fabric.damping = 0;
    tl_collider *collider = tl_collider_create(&box, false, &error);
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    vec3d start = cloth->particles.x[60];
    cloth_run(cloth, collider, seconds);
    vec3d moved = vec3d_sub(cloth->particles.x[60], start);
    double speed = tl_cloth_max_speed(cloth);
    assert_near(moved.x * sin(tilt_now) + moved.y * cos(tilt_now), 0, 2e-4); /* stays on the plane */
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&box);
    sheet_free(&garment);
    return (struct slid){moved.x * cos(tilt_now) - moved.y * sin(tilt_now), speed};
}

static void test_sticks(void **state)
{
    (void)state;
    const struct slope slopes[] = {{atan(0.38), 0.4}, {atan(0.9), 1.0}};
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++)
        for (size_t i = 0; i < TL_COUNT(slopes); i++) {
            struct slid slid = slide(&slopes[i], solver, 1);
            printf("sticks, %s, tan %.2f, mu %.1f: slides %.1e m in 1 s, ends at %.1e m/s\n",
                   tl_cloth_solver_names[solver], tan(slopes[i].tilt), slopes[i].friction, slid.distance,
                   slid.speed);
            assert_near(slid.distance, 0, 1e-4);
            assert_near(slid.speed, 0, 1e-4); /* less than the fall in half a substep */
        }
}

/* a/2 t^2, within the first-order error of short substeps and the duration of the first step with contact. */
static void test_slides(void **state)
{
    (void)state;
    const struct slope slopes[] = {{atan(0.5), 0.4}, {atan(1.0), 0.4}, {0.6, 0}};
    const double seconds = 0.5;
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++)
        for (size_t i = 0; i < TL_COUNT(slopes); i++) {
            double acceleration =
                params_defaults().gravity * (sin(slopes[i].tilt) - slopes[i].friction * cos(slopes[i].tilt));
            double expected = 0.5 * acceleration * seconds * seconds;
            double slid = slide(&slopes[i], solver, seconds).distance;
            printf("slides, %s, tan %.2f, mu %.1f: off by %+.2f %%\n", tl_cloth_solver_names[solver],
                   tan(slopes[i].tilt), slopes[i].friction, 100 * (slid / expected - 1));
            assert_near(slid, expected, 0.01 * expected);
        }
}

/* ---- Capstan: T2 / T1 = exp(mu phi) ---- */

/* Weightless. A strip runs up one side of a cylinder, over half of it and down the other side. Its first end
 * is held, its last one is drawn on slowly until the whole strip slides; then the tensions of the free ends
 * are compared. A vertex that turns by d has the ratio (1 + mu tan(d/2)) / (1 - mu tan(d/2)), so that turns
 * of 0.1 rad are right to mu phi d^2 / 12 (1 + mu^2): 0.1 %. Contact adds to it: a particle keeps its plane
 * while it slides from 0.9 times 1.5 mm (half the thickness) before the place where it touches to 1.5 mm
 * after it, so that on a radius of 0.1 m the plane leans against its way by 0.05 * 0.015 rad in the mean, as
 * much friction more: exp(0.00075 pi), 0.24 %; and what moves a little and turns is asked more often than
 * that: 1 %. */
#define RADIUS   0.1
#define STRAIGHT 20  /* rows at either end: pins within 0.1 m of the avatar would ride on it */
#define OVER     30  /* rows on half the cylinder */
#define RATE     480 /* frames a second */

static double out_of_axis(void)
{
    return RADIUS + thickness_m;
}

static vec3s wrap(double u, double v)
{
    double row = M_PI * out_of_axis() / OVER, along = v - STRAIGHT * row, angle = along / out_of_axis();
    double x = -out_of_axis(), y = along;
    if (angle > M_PI) {
        x = out_of_axis();
        y = OVER * row - along;
    } else if (angle > 0) {
        x = -out_of_axis() * cos(angle);
        y = out_of_axis() * sin(angle);
    }
    return (vec3s){{(float)x, (float)y, (float)u}};
}

/* Mean tension per width of the springs of rows [first, last), in both columns. */
static double tension(const tl_cloth *cloth, const struct sheet_shape *shape, int first, int last)
{
    double sum = 0, length = shape->height / shape->rows;
    for (int column = 0; column < 2; column++)
        for (int row = first; row < last; row++) {
            vec3d a = cloth->particles.x[sheet_vertex(shape, column, row)];
            vec3d b = cloth->particles.x[sheet_vertex(shape, column, row + 1)];
            sum += cloth->fabric.stretch_warp * (vec3d_distance(a, b) / length - 1) / (2 * (last - first));
        }
    return sum;
}

static double tension_ratio(int solver, double friction)
{
    tl_error error = {0};
    const int rows = 2 * STRAIGHT + OVER;
    const double row_m = M_PI * out_of_axis() / OVER;
    const struct sheet_shape shape = {1, rows, row_m, rows * row_m};
    tl_garment garment = sheet_make(&shape, wrap);
    for (int column = 0; column < 2; column++) {
        sheet_pin(&garment, sheet_vertex(&shape, column, 0));
        sheet_pin(&garment, sheet_vertex(&shape, column, rows));
    }
    tl_mesh cylinder = body_cylinder(RADIUS, -0.1, 0.1 + row_m, 512);
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_exact(solver);
    fabric.stretch_warp = 100;
    fabric.stretch_weft = fabric.shear = fabric.bend_weft = fabric.bend_warp = 0;
    fabric.friction = friction;
    fabric.thickness_m = thickness_m;
    fabric.damping = 10;
    params.gravity = 0;
    params.frame_rate = RATE;
    params_set_step(&params, 1.0 / 8000);
    tl_collider *collider = tl_collider_create(&cylinder, false, &error);
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    const int draws = 4 * RATE;
    for (int frame = 0; frame < draws; frame++) {
        for (size_t i = 0; i < cloth->pin_count; i++)
            if (cloth->pins[i].particle > 2)
                cloth->pins[i].at.y -= 0.05 / draws; /* 7 % of its length, without jerks */
        cloth_run(cloth, collider, 1 / params.frame_rate);
    }
    double slack = tension(cloth, &shape, 1, STRAIGHT - 1);
    double tight = tension(cloth, &shape, rows - STRAIGHT + 1, rows - 1);
    assert_true(slack > 0.5); /* N/m: the whole strip slides */
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&cylinder);
    sheet_free(&garment);
    return tight / slack;
}

static void test_capstan(void **state)
{
    (void)state;
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++) {
        const double friction = 0.4, ratio = tension_ratio(solver, friction), expected = exp(friction * M_PI);
        printf("capstan, %s, mu %.1f: T2/T1 %.4f, exp(mu pi) %.4f: off by %+.2f %%\n",
               tl_cloth_solver_names[solver], friction, ratio, expected, 100 * (ratio / expected - 1));
        assert_near(ratio, expected, 0.01 * expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sticks),
        cmocka_unit_test(test_slides),
        cmocka_unit_test(test_capstan),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
