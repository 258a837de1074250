/* Coming to rest: settled drapes of the solvers are compared, and cloth at rest must not move. */
#include "tests/cloth/bodies.h"
#include "tests/cloth/sheets.h"
#include "tests/cloth/solvers.h"

#include "cloth/measure.h"
#include "cloth/step/advance.h"
#include "config/base/log.h"

static vec3s lying(double u, double v)
{
    return (vec3s){{(float)u, 1.0f, (float)-v}};
}

/* ---- Drapes ---- */

static double elastic_and_potential(const tl_cloth *cloth)
{
    struct tl_cloth_report report = tl_cloth_measure(cloth, NULL);
    return report.elastic_energy + report.potential_energy;
}

/* Root mean square distance of two states of a sheet. The second one is mirrored at the plane z, which
 * contains the pins and the vertical: a mirrored equilibrium is an equilibrium too. */
static double rms_mirrored(const tl_cloth *a, const tl_cloth *b, double z)
{
    double sum = 0;
    for (size_t i = 0; i < a->particles.count; i++) {
        vec3d to = b->particles.x[i];
        to.z = 2 * z - to.z;
        vec3d offset = vec3d_sub(a->particles.x[i], to);
        sum += vec3d_dot(offset, offset);
    }
    return sqrt(sum / (double)a->particles.count);
}

static double rms(const tl_cloth *a, const tl_cloth *b)
{
    double sum = 0;
    for (size_t i = 0; i < a->particles.count; i++) {
        vec3d offset = vec3d_sub(a->particles.x[i], b->particles.x[i]);
        sum += vec3d_dot(offset, offset);
    }
    return sqrt(sum / (double)a->particles.count);
}

/* The smaller of both distances, plain and mirrored: rounding decides which of the two equilibria is reached.
 */
static double rms_of_twins(const tl_cloth *a, const tl_cloth *b, double z)
{
    return fmin(rms(a, b), rms_mirrored(a, b, z));
}

/* A sheet of 1 m hung by two corners. */
static tl_cloth *hang(const tl_garment *garment, int solver)
{
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    fabric.areal_density = 0.2;
    fabric.stretch_weft = fabric.stretch_warp = 1000;
    fabric.damping = 0; /* internal friction creeps for minutes */
    fabric.bend_weft = fabric.bend_warp = 1e-4;
    params.solver = solver;
    return cloth_make(garment, &fabric, &params);
}

/* Run under a drag until it no longer moves. */
static void run_to_stop(tl_cloth *cloth)
{
    tl_error error = {0};
    const struct tl_advance_params advance = {.drag = 4};
    for (int frame = 0; frame < 900 && (frame <= 30 || tl_cloth_max_speed(cloth) >= 1e-6); frame++)
        assert_ok(tl_cloth_advance(cloth, NULL, &advance, &error), error);
}

/* Settling comes near to the equilibrium of the exact solver by a path of its own: measured 1.4 mm, and
 * 1.3 after motion; without prestress `preview` is 2.9 mm off. TOILE_CELLS=32: a sheet of 33 x 33 vertices,
 * which takes the reference minutes. */
static void test_drapes_agree(void **state)
{
    (void)state;
    tl_error error = {0};
    const char *wanted = getenv("TOILE_CELLS");
    const int cells = wanted ? atoi(wanted) : 12;
    const struct sheet_shape shape = {cells, cells, 1, 1};
    tl_garment garment = sheet_make(&shape, lying);
    sheet_pin(&garment, sheet_vertex(&shape, 0, shape.rows));
    sheet_pin(&garment, sheet_vertex(&shape, shape.columns, shape.rows));
    tl_cloth *reference = hang(&garment, TL_CLOTH_REFERENCE), *settled = hang(&garment, TL_CLOTH_PREVIEW);
    run_to_stop(reference);
    assert_ok(tl_cloth_settle(settled, NULL, &error), error);
    double distance = rms_of_twins(settled, reference, -shape.height);
    double energy = elastic_and_potential(settled) - elastic_and_potential(reference);
    run_to_stop(settled);
    double moved = rms_of_twins(settled, reference, -shape.height);
    print_message("settled to reference: %.3f mm RMS, %.2e J; after motion %.3f mm\n", 1e3 * distance, energy,
                  1e3 * moved);
    assert_true(distance < 2e-3);
    assert_true(fabs(energy) < 2e-5);
    assert_true(moved < 2e-3);
    tl_cloth_destroy(&settled);
    tl_cloth_destroy(&reference);
    sheet_free(&garment);
}

/* ---- At rest ---- */

struct speeds {
    double per_substep; /* m/s, of a substep */
    double per_frame;   /* m/s, from frame to frame */
};

/* The largest speed of any vertex in the sixth second after settling. */
static struct speeds speeds_after_5_s(tl_cloth *cloth, const tl_collider *collider)
{
    struct speeds fastest = {0};
    double rate = cloth->params.frame_rate;
    vec3d *before = TL_NEW_ARRAY(vec3d, cloth->particles.count);
    cloth_run(cloth, collider, 5);
    for (int frame = 0; frame < 30; frame++) {
        memcpy(before, cloth->particles.x, cloth->particles.count * sizeof *before);
        cloth_run(cloth, collider, 1 / rate);
        fastest.per_substep = fmax(fastest.per_substep, tl_cloth_max_speed(cloth));
        for (size_t i = 0; i < cloth->particles.count; i++)
            fastest.per_frame =
                fmax(fastest.per_frame, rate * vec3d_distance(cloth->particles.x[i], before[i]));
    }
    free(before);
    return fastest;
}

struct resting {
    const char *name;
    vec3s (*place)(double u, double v);
    bool pinned, ground;
    double sphere; /* radius; 0: none */
};

static vec3s over_sphere(double u, double v)
{
    return (vec3s){{(float)(u - 0.25), 0.75f, (float)(0.25 - v)}};
}

static vec3s near_ground(double u, double v)
{
    return (vec3s){{(float)u, 0.02f, (float)-v}};
}

static struct speeds run_to_rest(const struct resting *resting, int solver)
{
    tl_error error = {0};
    const struct sheet_shape shape = {12, 12, 0.5, 0.5};
    tl_garment garment = sheet_make(&shape, resting->place);
    tl_mesh sphere = body_sphere((vec3s){{0, 0.5f, 0}}, resting->sphere, 24);
    if (resting->pinned) {
        sheet_pin(&garment, sheet_vertex(&shape, 0, shape.rows));
        sheet_pin(&garment, sheet_vertex(&shape, shape.columns, shape.rows));
    }
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    params.solver = solver;
    tl_collider *collider = tl_collider_create(resting->sphere > 0 ? &sphere : NULL, resting->ground, &error);
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    assert_ok(tl_cloth_settle(cloth, collider, &error), error);
    struct speeds speeds = speeds_after_5_s(cloth, collider);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&sphere);
    sheet_free(&garment);
    return speeds;
}

/* Frame to frame: a sixth of a millimetre, a pixel of a garment that fills the screen. The reference still
 * swings from where forces balance; `preview` has come to rest there in motion.
 * Within substeps: contact pushes that cancel within a few substeps, which are as short as 1e-5 s in
 * `reference`. */
static void test_rest_is_at_rest(void **state)
{
    (void)state;
    const struct speeds bounds[] = {[TL_CLOTH_PREVIEW] = {.per_substep = 1e-2, .per_frame = 5e-3},
                                    [TL_CLOTH_REFERENCE] = {.per_substep = 2e-2, .per_frame = 2e-2}};
    const struct resting cases[] = {
        {"hanging", lying, true, false, 0},
        {"on the ground", near_ground, false, true, 0},
        {"on a sphere", over_sphere, false, true, 0.2},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++)
        for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++) {
            struct speeds speeds = run_to_rest(&cases[i], solver);
            print_message("%s, %s, after 5 s: at most %.1e m/s from frame to frame, %.1e m/s in a substep\n",
                          cases[i].name, tl_cloth_solver_names[solver], speeds.per_frame, speeds.per_substep);
            assert_true(speeds.per_frame < bounds[solver].per_frame);
            assert_true(speeds.per_substep < bounds[solver].per_substep);
        }
}

/* ---- Meshes ---- */

/* How far a strip that hangs by its upper side is longer than its pattern, m. */
static double sag(const struct sheet_shape *shape)
{
    tl_error error = {0};
    tl_garment garment = sheet_make(shape, NULL);
    for (int column = 0; column <= shape->columns; column++)
        sheet_pin(&garment, sheet_vertex(shape, column, shape->rows));
    struct tl_cloth_fabric fabric = fabric_defaults();
    struct tl_cloth_params params = params_defaults();
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    assert_ok(tl_cloth_settle(cloth, NULL, &error), error);
    assert_true(tl_cloth_is_settled(cloth));
    double lowest = -cloth->particles.x[cloth->topology.weld[sheet_vertex(shape, shape->columns / 2, 0)]].y;
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
    return lowest;
}

/* A fine mesh hangs as a coarse one does: relaxation leaves nothing stretched. */
static void test_meshes_agree(void **state)
{
    (void)state;
    const struct sheet_shape shapes[] = {{8, 34, 0.15, 0.6}, {17, 68, 0.15, 0.6}};
    double coarse = sag(&shapes[0]);
    print_message("a strip of 0.6 m is longer by %.2f mm", 1e3 * coarse);
    for (size_t i = 1; i < TL_COUNT(shapes); i++) {
        double fine = sag(&shapes[i]);
        print_message(", %.2f mm", 1e3 * fine);
        assert_true(fabs(fine - coarse) < 0.02 * coarse);
    }
    print_message("\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_meshes_agree),
        cmocka_unit_test(test_drapes_agree),
        cmocka_unit_test(test_rest_is_at_rest),
    };
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
