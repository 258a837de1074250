/* Plies lie on each other at the distance of their fabric's thickness. Stacks of sheets: none passes through
 * another or into the body below, and friction carries all of them. TOILE_SHEETS and TOILE_FRAMES set how
 * many fall on the ball, and for how long. */
#include "tests/cloth/bodies.h"
#include "tests/cloth/crossing_oracle.h"
#include "tests/cloth/solvers.h"

#include <time.h>

#define ABOVE_M   0.004 /* the lowest sheet's start over the body; the avatar's distance is 3 mm */
#define GAP_M     0.006 /* sheets at their start */
#define SHEETS    20
#define FRAMES    7
#define BALL      0.12
#define SHEET_M   0.36
#define COLUMNS   7
#define TURN_RAD  0.3 /* of each sheet against the one below it */
#define SUNK_M    1e-3
#define BOX_TOP   0.5f
#define ON_BOX    2
#define SLIGHTEST 1e-4
#define ON_SLOPE  6
#define LANDING   12
#define SLOPE_RAD 0.26 /* 15 degrees; friction of 0.4 holds up to 22 */

/* Adds a sheet at a height over the plane that passes the origin and is tilted by `tilt` about the z axis; it
 * is turned by `turn` in the plane. */
static void add_sheet(tl_garment *garment, double height, double turn, double tilt)
{
    const struct sheet_shape shape = {COLUMNS, COLUMNS, SHEET_M, SHEET_M};
    tl_garment sheet = sheet_make(&shape, NULL);
    tl_mesh *all = &garment->model.mesh, *mesh = &sheet.model.mesh;
    size_t first = all->vertex_count, count = first + mesh->vertex_count;
    all->positions = tl_resize(all->positions, count, sizeof *all->positions);
    all->normals = tl_resize(all->normals, count, sizeof *all->normals);
    all->uvs = tl_resize(all->uvs, count, sizeof *all->uvs);
    all->indices = tl_resize(all->indices, all->index_count + mesh->index_count, sizeof *all->indices);
    garment->pattern = tl_resize(garment->pattern, count, sizeof *garment->pattern);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        double u = (double)sheet.pattern[i].x - SHEET_M / 2, v = (double)sheet.pattern[i].y - SHEET_M / 2;
        double along = u * cos(turn) + v * sin(turn), across = u * sin(turn) - v * cos(turn);
        garment->pattern[first + i] = sheet.pattern[i];
        all->uvs[first + i] = mesh->uvs[i];
        all->normals[first + i] = (vec3s){{0, 1, 0}};
        all->positions[first + i] = (vec3s){{(float)(along * cos(tilt) - height * sin(tilt)),
                                             (float)(along * sin(tilt) + height * cos(tilt)), (float)across}};
    }
    for (size_t i = 0; i < mesh->index_count; i++)
        all->indices[all->index_count++] = (uint32_t)first + mesh->indices[i];
    all->vertex_count = count;
    sheet_free(&sheet);
}

/* Mean distance of two sheets at rest on a box that is larger than they are. */
static double resting_gap(const struct tl_cloth_fabric *fabric, int solver)
{
    tl_error error = {0};
    tl_garment garment = {0};
    tl_mesh box = body_box((vec3s){{0, BOX_TOP - 0.05f, 0}}, (vec3s){{0.5f, 0.05f, 0.5f}}, 0);
    for (int i = 0; i < ON_BOX; i++)
        add_sheet(&garment, (double)BOX_TOP + ABOVE_M + i * GAP_M, 0, 0);
    struct tl_cloth_params params = params_defaults();
    params.solver = solver;
    tl_collider *collider = tl_collider_create(&box, false, &error);
    tl_cloth *cloth = cloth_make(&garment, fabric, &params);
    cloth_run(cloth, collider, 1);
    double sum = 0;
    size_t each = cloth->particles.count / 2;
    for (size_t i = 0; i < each; i++)
        sum += cloth->particles.x[each + i].y - cloth->particles.x[i].y;
    assert_int_equal(tl_cloth_measure(cloth, NULL).crossing_count, 0);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&box);
    sheet_free(&garment);
    return sum / (double)each;
}

/* What is pressed on another sheet sinks by what it falls within a substep, a few micrometres. */
static void test_thickness(void **state)
{
    (void)state;
    const double sink_m = 2e-5;
    const struct {
        double ply_m, density, expected_m;
    } cases[] = {{0.0008, 0.15, 0.0008}, {0.0002, 0.15, 0.0002}, {0, 0.15, 0.0003}, {0, 0.02, SLIGHTEST}};
    for (int solver = 0; solver < TL_CLOTH_REFERENCE; solver++)
        for (size_t i = 0; i < TL_COUNT(cases); i++) {
            struct tl_cloth_fabric fabric = fabric_defaults();
            fabric.ply_m = cases[i].ply_m;
            fabric.areal_density = cases[i].density;
            assert_near(tl_cloth_fabric_ply(&fabric), cases[i].expected_m, 1e-12);
            double gap = resting_gap(&fabric, solver);
            printf("%s, ply %g mm: %.4f mm apart\n", tl_cloth_solver_names[solver], 1e3 * cases[i].expected_m,
                   1e3 * gap);
            assert_near(gap, cases[i].expected_m, sink_m);
        }
}

/* Sheets on a slope that friction holds stay where they are. Where a sweep moved both plies of a contact,
 * each sheet would slip on the one below it by a multiple of g h^2 in each substep. */
static void test_slope(void **state)
{
    (void)state;
    const double lie_s = 0.3, seconds = 0.5, creep_m = 5e-4;
    tl_error error = {0};
    tl_garment garment = {0};
    tl_mesh box = body_box((vec3s){{(float)(0.05 * sin(SLOPE_RAD)), (float)(-0.05 * cos(SLOPE_RAD)), 0}},
                           (vec3s){{0.5f, 0.05f, 0.5f}}, SLOPE_RAD);
    for (int i = 0; i < ON_SLOPE; i++)
        add_sheet(&garment, ABOVE_M + i * GAP_M, 0, SLOPE_RAD);
    const struct tl_cloth_fabric fabric = fabric_defaults();
    const struct tl_cloth_params params = params_defaults();
    tl_collider *collider = tl_collider_create(&box, false, &error);
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    size_t each = cloth->particles.count / ON_SLOPE;
    double before[ON_SLOPE] = {0}, after[ON_SLOPE] = {0};
    cloth_run(cloth, collider, lie_s);
    for (size_t i = 0; i < cloth->particles.count; i++)
        before[i / each] += cloth->particles.x[i].x / (double)each;
    cloth_run(cloth, collider, seconds);
    for (size_t i = 0; i < cloth->particles.count; i++)
        after[i / each] += cloth->particles.x[i].x / (double)each;
    for (int i = 0; i < ON_SLOPE; i++) {
        printf("sheet %d slid by %.3f mm in %.1f s\n", i, 1e3 * (after[i] - before[i]), seconds);
        assert_near(after[i], before[i], creep_m);
    }
    assert_int_equal(oracle_crossings(&cloth->topology, cloth->particles.x), 0);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&box);
    sheet_free(&garment);
}

static int number_of(const char *variable, int usual)
{
    const char *wanted = getenv(variable);
    return wanted ? atoi(wanted) : usual;
}

/* Sheets press the lowest ones into the ball, which lets none of them through the others: only a body that
 * moves may. */
static void test_ball(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_garment garment = {0};
    const int sheets = number_of("TOILE_SHEETS", SHEETS), frames = number_of("TOILE_FRAMES", FRAMES);
    tl_mesh ball = body_sphere((vec3s){{0, 1, 0}}, BALL, 24);
    for (int i = 0; i < sheets; i++)
        add_sheet(&garment, 1 + BALL + ABOVE_M + i * GAP_M, i * TURN_RAD, 0);
    const struct tl_cloth_fabric fabric = fabric_defaults();
    const struct tl_cloth_params params = params_defaults();
    tl_collider *collider = tl_collider_create(&ball, true, &error);
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    double strain = 0, deepest = 0;
    clock_t before = clock();
    for (int frame = 1; frame <= frames; frame++) {
        assert_ok(tl_cloth_step(cloth, collider, &error), error);
        struct tl_cloth_report report = tl_cloth_measure(cloth, collider);
        assert_int_equal(report.crossing_count, 0);
        if (frame == frames / 2 || frame == frames)
            assert_int_equal(oracle_crossings(&cloth->topology, cloth->particles.x), 0);
        strain = fmax(strain, report.max_strain);
        deepest = fmax(deepest, report.deepest_m);
    }
    printf("%d sheets on a ball: no crossing in %d frames, strain %.2f, %.3f mm in the ball, %.0f ms CPU a "
           "frame\n",
           sheets, frames, strain, 1e3 * deepest, 1e3 * (double)(clock() - before) / CLOCKS_PER_SEC / frames);
    assert_true(strain < 1);
    assert_true(deepest < SUNK_M);
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    tl_mesh_release(&ball);
    sheet_free(&garment);
}

/* A stack of thin sheets that falls on the ground at 10 m/s: sheets that come later do not press the first
 * ones into it. */
static void test_landing(void **state)
{
    (void)state;
    const double speed = 10, above_m = 0.1, tilt = 0.01;
    const int frame_count = 3;
    tl_error error = {0};
    tl_garment garment = {0};
    for (int i = 0; i < LANDING; i++)
        add_sheet(&garment, above_m + i * GAP_M, i * TURN_RAD, i * tilt);
    struct tl_cloth_fabric fabric = fabric_defaults();
    fabric.thickness_m = 0.0006;
    const struct tl_cloth_params params = params_defaults();
    tl_collider *collider = tl_collider_create(NULL, true, &error);
    tl_cloth *cloth = cloth_make(&garment, &fabric, &params);
    for (size_t i = 0; i < cloth->particles.count; i++)
        cloth->particles.v[i].y = -speed;
    for (int frame = 0; frame < frame_count; frame++) {
        assert_ok(tl_cloth_step(cloth, collider, &error), error);
        const struct tl_cloth_report report = tl_cloth_measure(cloth, collider);
        printf("landing: %.3f mm in the ground\n", 1e3 * report.deepest_m);
        assert_true(report.deepest_m < SUNK_M);
        assert_int_equal(report.crossing_count, 0);
    }
    tl_cloth_destroy(&cloth);
    tl_collider_destroy(&collider);
    sheet_free(&garment);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_thickness),
        cmocka_unit_test(test_slope),
        cmocka_unit_test(test_ball),
        cmocka_unit_test(test_landing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
