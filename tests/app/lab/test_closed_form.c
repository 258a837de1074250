/* The oracles of cloth measurements: the tube's closed form compared with sums over its triangles, cells with
 * a known outcome, and the plain loop's sag. */
#include "tests/testing.h"

#include "app/lab/cloth/plain_loop.h"
#include "config/base/memory.h"
#include "tests/app/stability/envelope.h"

#include <string.h>

/* Weight of every vertex row (a third of each triangle's area at its corners) and each row of cells'
 * stiffness k A / height^2, summed over the triangles; then sinks by rows. */
static void sums_over_triangles_agree(void **state)
{
    (void)state;
    const struct tl_tube tubes[] = {{3, 3, 1, 1}, {5, 19, 1, 1e3}, {7, 12, 0.01, 1e6}, {4, 8, 100, 10}};
    const double gravity = 9.81;
    struct tl_cloth_fabric fabric = *(const struct tl_cloth_fabric *)tl_cloth_fabric_options.defaults;
    for (size_t t = 0; t < TL_COUNT(tubes); t++) {
        const struct tl_tube *tube = &tubes[t];
        tl_garment garment = tl_tube_make(tube, NULL, 0);
        const tl_mesh *mesh = &garment.model.mesh;
        double weights[32] = {0}, stiffness[32] = {0}, sinks[32], sink = 0, hanging = 0, length = 0;
        for (size_t i = 0; i < mesh->index_count; i += 3) {
            const uint32_t *corner = &mesh->indices[i];
            int rows[3], upper = tube->row_count;
            for (int k = 0; k < 3; k++) {
                rows[k] = (int)corner[k] / (tube->columns + 1);
                upper = rows[k] < upper ? rows[k] : upper;
            }
            double height = tl_tube_row_height(tube, upper), area = height * tl_tube_width(tube) / 2;
            for (int k = 0; k < 3; k++)
                weights[rows[k]] += area / 3 * fabric.areal_density * gravity;
            stiffness[upper] += fabric.stretch_warp * area / (height * height);
        }
        tl_tube_sink(tube, &fabric, gravity, sinks);
        assert_near(sinks[0], 0, 0);
        for (int row = 1; row <= tube->row_count; row++)
            hanging += weights[row];
        for (int row = 0; row < tube->row_count; row++) {
            sink += hanging / stiffness[row];
            hanging -= weights[row + 1];
            length += tl_tube_row_height(tube, row);
            assert_near(sinks[row + 1] / sink, 1, 1e-9);
        }
        assert_near(length, tube->height_m, 1e-12 * tube->height_m);
        assert_near(tl_tube_row_height(tube, tube->row_count - 1) / tl_tube_row_height(tube, 0),
                    tube->mass_ratio, 1e-9 * tube->mass_ratio);
        tl_garment_release(&garment);
    }
}

/* The seam of a scrambled tube stays welded: both its columns are moved alike, by no more than is asked. */
static void scrambles_stay_in_reach(void **state)
{
    (void)state;
    const struct tl_tube tube = {5, 6, 1, 1};
    const double share = 0.2;
    tl_garment still = tl_tube_make(&tube, NULL, 0), moved = tl_tube_make(&tube, NULL, share);
    double reach = share * fmin(tl_tube_width(&tube), tl_tube_row_height(&tube, 0)), farthest = 0;
    for (int row = 0; row <= tube.row_count; row++) {
        const vec3s *x = &moved.model.mesh.positions[(size_t)row * ((size_t)tube.columns + 1)];
        assert_memory_equal(&x[0], &x[tube.columns], sizeof *x);
        for (int column = 0; column <= tube.columns; column++) {
            vec3s from = still.model.mesh.positions[row * (tube.columns + 1) + column];
            double way = (double)glms_vec3_distance(from, x[column]);
            assert_true(way <= sqrt(3) * reach * (1 + 1e-5));
            assert_true(row > 0 || way == 0);
            farthest = fmax(farthest, way);
        }
    }
    assert_true(farthest > reach / 2);
    tl_garment_release(&still);
    tl_garment_release(&moved);
}

/* A tube of ordinary cloth is within what every solver promises; one that must stretch by more than the
 * envelope is refused, and so is a step that the reference's budget does not allow. */
static void known_cells(void **state)
{
    (void)state;
    const struct tl_envelope_size size = {"12", 3, 3, true, true};
    const struct {
        int solver;
        enum tl_outcome outcome;
        double stiffness, dt, ratio, height_m;
    } cells[] = {
        {TL_CLOTH_REFERENCE, TL_OUTCOME_EXACT, 1e3, 1e-2, 1, 1},
        {TL_CLOTH_PREVIEW, TL_OUTCOME_BOUNDED, 1e9, 1e-1, 1, 1},
        {TL_CLOTH_PREVIEW, TL_OUTCOME_REFUSED, 1e-2, 1e-2, 1, 100},
        {TL_CLOTH_REFERENCE, TL_OUTCOME_REFUSED, 1e-2, 1e-2, 1, 100},
        {TL_CLOTH_REFERENCE, TL_OUTCOME_REFUSED, 1e9, 1e-1, 1e6, 1},
    };
    for (size_t i = 0; i < TL_COUNT(cells); i++) {
        const struct tl_envelope_case tested = {.size = &size,
                                                .solver = cells[i].solver,
                                                .stiffness = cells[i].stiffness,
                                                .dt = cells[i].dt,
                                                .mass_ratio = cells[i].ratio,
                                                .height_m = cells[i].height_m};
        struct tl_envelope_cell cell = tl_envelope_run(&tested);
        if (cell.outcome != cells[i].outcome)
            print_error("cell %zu: %s\n", i, cell.message.message);
        assert_int_equal(cell.outcome, cells[i].outcome);
        assert_true((cell.outcome == TL_OUTCOME_REFUSED) == (cell.message.message[0] != '\0'));
    }
}

/* Hung from rest it swings about its static stretch, density g / k at the top by twice that at most. */
static void plain_loop_hangs(void **state)
{
    (void)state;
    tl_plain_loop *loop = tl_plain_loop_create(17);
    double maximum = 0;
    for (int i = 0; i < 2000; i++) {
        tl_plain_loop_step(loop);
        maximum = fmax(maximum, tl_plain_loop_stretch(loop) - 1);
    }
    const double still = 0.2 * 9.81 / 1000; /* springs across and along diagonals carry a part of it */
    assert_true(maximum > 0.3 * still && maximum < 3 * still);
    tl_plain_loop_destroy(&loop);
}

/* The upper half of this tube consists of needle triangles, thirty times as wide as high. A single sweep
 * moved it by 0.19 mm within two milliseconds under its own weight, ten times a free fall. The bound is the
 * envelope's. */
static void needles_stay_in_place(void **state)
{
    (void)state;
    static const struct tl_envelope_size size = {"1000", 10, 99, true, false};
    const struct tl_envelope_case tested = {.size = &size,
                                            .solver = TL_CLOTH_PREVIEW,
                                            .stiffness = 1e4,
                                            .dt = 1e-5,
                                            .mass_ratio = 1e3,
                                            .height_m = 1};
    struct tl_envelope_cell cell = tl_envelope_run(&tested);
    printf("needles: %s, strays by %.3g of what is exact %s\n", tl_outcome_names[cell.outcome], cell.strayed,
           cell.message.message);
    assert_true(cell.outcome == TL_OUTCOME_EXACT || cell.outcome == TL_OUTCOME_BOUNDED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_over_triangles_agree),
        cmocka_unit_test(scrambles_stay_in_reach),
        cmocka_unit_test(known_cells),
        cmocka_unit_test(needles_stay_in_place),
        cmocka_unit_test(plain_loop_hangs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
