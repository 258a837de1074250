/* The residual of states whose imbalance is known: a strip that hangs stretched by its weight, one that is
 * not stretched, sheets on a slope and on each other. */
#include "cloth/build.h"
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"
#include "tests/cloth/solvers.h"

#include "config/base/log.h"

/* Of the weight. Bending resists uneven stretch as it does curvature: 1e-5 of the strip's weight. */
#define TINY 1e-4

static struct tl_residual measure(const tl_cloth *cloth, const tl_collider *collider, const char *name)
{
    const struct tl_residual residual = tl_cloth_residual(cloth, collider);
    print_message("%s: %.3g rms, %.3g for 99 %%, %.3g at most\n", name, residual.rms, residual.high,
                  residual.largest);
    return residual;
}

static void assert_all_near(const struct tl_residual *residual, double expected, double tolerance)
{
    assert_near(residual->rms, expected, tolerance);
    assert_near(residual->high, expected, tolerance);
    assert_near(residual->largest, expected, tolerance);
}

/* ---- Hanging ---- */

/* Sides of 1/32 m, which floats hold exactly: a rounded one is strained. */
static const struct sheet_shape strip = {4, 20, 0.125, 0.625};

/* A strip that hangs by its upper side. Its masses are those of a rectangle: corners of its triangles weigh
 * more at one end of their diagonal, which would shear it. */
static tl_cloth *hang(tl_garment *garment)
{
    const struct tl_cloth_fabric fabric = fabric_defaults();
    const struct tl_cloth_params params = params_defaults();
    *garment = sheet_make(&strip, NULL);
    for (int column = 0; column <= strip.columns; column++)
        sheet_pin(garment, sheet_vertex(&strip, column, strip.rows));
    tl_cloth *cloth = cloth_make(garment, &fabric, &params);
    const double cell = strip.width * strip.height / (strip.columns * strip.rows);
    for (int row = 0; row < strip.rows; row++)
        for (int column = 0; column <= strip.columns; column++) {
            double share = (row == 0 ? 0.5 : 1) * (column == 0 || column == strip.columns ? 0.5 : 1);
            cloth->particles.w[cloth->topology.weld[sheet_vertex(&strip, column, row)]] =
                1 / (share * cell * fabric.areal_density);
        }
    return cloth;
}

/* Stretches each row by the weight of what hangs below it, over the stiffness. */
static void stretch(const tl_cloth *cloth)
{
    const double side = strip.height / strip.rows;
    double y = 0;
    for (int row = strip.rows; row >= 0; row--) {
        for (int column = 0; column <= strip.columns; column++)
            cloth->particles.x[cloth->topology.weld[sheet_vertex(&strip, column, row)]].y = y;
        const double weight = 9.81 * cloth->fabric.areal_density * side * (row - 0.5);
        y -= side * (1 + weight / cloth->fabric.stretch_warp);
    }
}

static void test_hanging(void **state)
{
    (void)state;
    tl_garment garment;
    tl_cloth *cloth = hang(&garment);
    struct tl_residual residual = measure(cloth, NULL, "not stretched: falls");
    assert_all_near(&residual, 1, TINY);
    stretch(cloth);
    residual = measure(cloth, NULL, "stretched by its weight");
    assert_all_near(&residual, 0, TINY);
    cloth_run(cloth, NULL, 1);
    residual = measure(cloth, NULL, "after a second of `preview`");
    assert_true(residual.rms > TL_RESIDUAL_RMS);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* The farthest that a vertex of the stretched strip has gone after a second of `preview`. */
static double go_from_balance(int substeps, bool is_prestressed)
{
    tl_garment garment;
    tl_error error = {0};
    tl_cloth *cloth = hang(&garment);
    struct tl_cloth_params params = cloth->params;
    params.substeps = substeps;
    cloth->params = params;
    stretch(cloth);
    for (size_t i = 0; i < cloth->pin_count; i++)
        cloth->pins[i].at = cloth->particles.x[cloth->pins[i].particle];
    tl_cloth_set_prestress(cloth, is_prestressed);
    vec3d *from = TL_NEW_ARRAY(vec3d, cloth->particles.count);
    memcpy(from, cloth->particles.x, cloth->particles.count * sizeof *from);
    for (int frame = 0; frame < 30; frame++)
        assert_ok(tl_cloth_step(cloth, NULL, &error), error);
    double farthest = 0;
    for (size_t i = 0; i < cloth->particles.count; i++)
        farthest = fmax(farthest, vec3d_distance(cloth->particles.x[i], from[i]));
    print_message("%d substeps, %s: goes by %.3g mm\n", substeps, is_prestressed ? "prestressed" : "not",
                  1e3 * farthest);
    free(from);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
    return farthest;
}

/* Prestressed cloth stays where it is in balance, in substeps of any length. */
static void test_prestress(void **state)
{
    (void)state;
    assert_true(go_from_balance(10, false) > 1e-3);
    assert_true(go_from_balance(10, true) < 1e-6);
    assert_true(go_from_balance(2, true) < 1e-6);
}

/* ---- Lying ---- */

#define SLOPE (30 * M_PI / 180)

static double thickness(void)
{
    return fabric_defaults().thickness_m;
}

/* In doubles: strains of rounded positions count. */
static void lay_on_slope(const tl_cloth *cloth, const tl_garment *garment)
{
    const double up = thickness();
    for (size_t i = 0; i < garment->model.mesh.vertex_count; i++) {
        const double u = (double)garment->pattern[i].x - 0.125, v = (double)garment->pattern[i].y;
        cloth->particles.x[cloth->topology.weld[i]] =
            (vec3d){u * cos(SLOPE) - up * sin(SLOPE), 1 + u * sin(SLOPE) + up * cos(SLOPE), 0.125 - v};
    }
}

/* A sheet slides by g (sin - friction cos), or not at all. */
static void test_slope(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {8, 8, 0.25, 0.25};
    const vec3s half = {{0.5f, 0.1f, 0.5f}};
    const vec3s centre = {{(float)(0.1 * sin(SLOPE)), (float)(1 - 0.1 * cos(SLOPE)), 0}};
    tl_mesh box = body_box(centre, half, SLOPE);
    tl_garment garment = sheet_make(&shape, NULL);
    tl_collider *collider = tl_collider_create(&box, false, &error);
    assert_ok(collider != NULL, error);
    const double frictions[] = {0, 0.3, 0.6};
    for (size_t i = 0; i < TL_COUNT(frictions); i++) {
        struct tl_cloth_fabric fabric = fabric_defaults();
        const struct tl_cloth_params params = params_defaults();
        fabric.friction = frictions[i];
        tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
        lay_on_slope(cloth, &garment);
        const struct tl_residual residual = measure(cloth, collider, "on a slope");
        assert_all_near(&residual, fmax(sin(SLOPE) - frictions[i] * cos(SLOPE), 0), 1e-3);
        tl_cloth_destroy(&cloth);
    }
    tl_collider_destroy(&collider);
    tl_mesh_release(&box);
    sheet_free(&garment);
}

enum { PLY = 6 }; /* squares of a side */

/* One sheet on the ground, and another one on it. */
static vec3s stacked(double u, double v)
{
    const struct tl_cloth_fabric fabric = fabric_defaults();
    const double side = 1.0 / 64;
    bool upper = u > (PLY + 0.5) * side;
    return (vec3s){{(float)(upper ? u - (PLY + 1) * side : u),
                    (float)(thickness() + (upper ? tl_cloth_fabric_ply(&fabric) : 0)), (float)-v}};
}

static void test_stack(void **state)
{
    (void)state;
    tl_error error = {0};
    const struct sheet_shape shape = {2 * PLY + 1, PLY, (2 * PLY + 1) / 64.0, PLY / 64.0};
    tl_garment garment = sheet_make(&shape, stacked);
    tl_mesh *mesh = &garment.model.mesh;
    size_t kept = 0;
    for (size_t i = 0; i < mesh->index_count / 6; i++) /* without the column between both */
        if (i % (2 * PLY + 1) != PLY) {
            memmove(&mesh->indices[kept], &mesh->indices[6 * i], 6 * sizeof *mesh->indices);
            kept += 6;
        }
    mesh->index_count = kept;
    tl_collider *ground = tl_collider_create(NULL, true, &error);
    assert_ok(ground != NULL, error);
    const struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    for (int self_contact = 0; self_contact < 2; self_contact++) {
        params.self_contact = self_contact;
        tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
        const struct tl_residual residual =
            measure(cloth, ground, self_contact ? "on each other" : "through each other");
        /* half of the vertices fall through the others, which lie on the ground */
        assert_near(residual.rms, self_contact ? 0 : sqrt(0.5), 1e-3);
        assert_near(residual.largest, self_contact ? 0 : 1, 1e-3);
        tl_cloth_destroy(&cloth);
    }
    tl_collider_destroy(&ground);
    sheet_free(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hanging),
        cmocka_unit_test(test_prestress),
        cmocka_unit_test(test_slope),
        cmocka_unit_test(test_stack),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
