/* Orders of convergence: of each solver's motion in the step, and of the rest shape in the mesh against a
 * continuum.
 *
 * Motion is compared before anything buckles or touches: a sheet clamped along an edge swings under its
 * weight. A sheet pinned at corners only would be singular: its strain there grows without bound as the mesh
 * is refined. */
#include "tests/cloth/solvers.h"

#include "cloth/timestep.h"
#include "config/base/log.h"

/* ---- In the step ---- */

static const struct sheet_shape swing_shape = {6, 6, 0.25, 0.25};
#define SWING_VERTICES 49
#define SWING_S        (1.0 / 8)

/* Level, clamped along v = 0: its first two rows are held. */
static vec3s level(double u, double v)
{
    return (vec3s){{(float)u, 1, (float)v}};
}

static void swing(int solver, double h, vec3d out[SWING_VERTICES])
{
    tl_garment garment = sheet_make(&swing_shape, level);
    for (int column = 0; column <= swing_shape.columns; column++)
        for (int row = 0; row < 2; row++)
            sheet_pin(&garment, sheet_vertex(&swing_shape, column, row));
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_exact(solver);
    fabric.stretch_weft = fabric.stretch_warp = 40;
    fabric.shear = 10;
    fabric.bend_weft = fabric.bend_warp = 1e-4;
    fabric.damping = 0;
    params.frame_rate = 1 / SWING_S;
    params_set_step(&params, h);
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    assert_near(tl_cloth_substep(cloth), h, 1e-12);
    cloth_run(cloth, NULL, SWING_S);
    memcpy(out, cloth->particles.x, SWING_VERTICES * sizeof *out);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

static double rms_distance(const vec3d *a, const vec3d *b)
{
    double sum = 0;
    for (int i = 0; i < SWING_VERTICES; i++)
        sum += vec3d_dot(vec3d_sub(a[i], b[i]), vec3d_sub(a[i], b[i])) / SWING_VERTICES;
    return sqrt(sum);
}

/* The reference is Verlet at a step that leaves (1/8)^2 of the finest step's error. */
static void test_step(void **state)
{
    (void)state;
    vec3d exact[SWING_VERTICES], at[SWING_VERTICES];
    swing(TL_CLOTH_REFERENCE, 1.0 / 65536, exact);
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++) {
        double errors[4], expected = solver_rule(solver) == RULE_VERLET ? 2 : 1, order = 0;
        for (int i = 0; i < 4; i++) {
            swing(solver, 1.0 / (1024 << i), at);
            errors[i] = rms_distance(at, exact);
        }
        order = observed_order(errors[2], errors[3]);
        printf("%s: RMS %.2e, %.2e, %.2e, %.2e m off at 1/1024 to 1/8192 s: order %.2f\n",
               tl_cloth_solver_names[solver], errors[0], errors[1], errors[2], errors[3], order);
        assert_near(order, expected, 0.15);
    }
}

/* ---- In the mesh ---- */

static const double span_m = 0.75, stretch = 50;

static vec3s sag(double u, double v)
{
    return (vec3s){{(float)(span_m * v), (float)(-1.4 * v * (1 - v)), (float)u}};
}

/* Sag of the elastic catenary of length 1 over the span, ends level: with the tension H across at its middle
 * and weight w, x(s) = H/w asinh(w s/H) + H s/k and y(s) = sqrt((H/w)^2 + s^2) + w s^2 / 2k from there. */
static double continuum_sag(void)
{
    double w = fabric_defaults().areal_density * params_defaults().gravity, low = 1e-6, high = 100, s = 0.5;
    for (int i = 0; i < 200; i++) {
        double across = (low + high) / 2;
        double x = across / w * asinh(w * s / across) + across * s / stretch;
        if (2 * x < span_m)
            low = across;
        else
            high = across;
    }
    double reach = low / w;
    return sqrt(reach * reach + s * s) - reach + w * s * s / (2 * stretch);
}

/* A sheet of several columns, with stiffness along weft and in shear, hangs as a chain does. */
static double sheet_sag(int rows)
{
    const struct sheet_shape shape = {3, rows, 3.0 / rows, 1};
    tl_garment garment = sheet_make(&shape, sag);
    for (int column = 0; column <= shape.columns; column++) {
        sheet_pin(&garment, sheet_vertex(&shape, column, 0));
        sheet_pin(&garment, sheet_vertex(&shape, column, rows));
    }
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_exact(TL_CLOTH_REFERENCE);
    fabric.stretch_weft = fabric.stretch_warp = stretch;
    fabric.shear = 10;
    fabric.bend_weft = fabric.bend_warp = 0;
    fabric.damping = 3;
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    cloth_run(cloth, NULL, 12);
    double lowest = -cloth->particles.x[sheet_vertex(&shape, 1, rows / 2)].y;
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
    return lowest;
}

static void test_mesh(void **state)
{
    (void)state;
    double expected = continuum_sag(), errors[4];
    for (int i = 0; i < 4; i++) {
        errors[i] = fabs(sheet_sag(8 << i) - expected);
        printf("%d rows: sag off by %.2e of %.4f m%s\n", 8 << i, errors[i], expected, i ? "" : ":");
    }
    for (int i = 1; i < 4; i++) {
        double order = observed_order(errors[i - 1], errors[i]);
        printf("from %d to %d rows: order %.2f\n", 4 << i, 8 << i, order);
        assert_near(order, 2, 0.15);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_step),
        cmocka_unit_test(test_mesh),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
