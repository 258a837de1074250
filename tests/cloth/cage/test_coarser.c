/* Coarser cloths: carrying against rigid motions, and settling by cages against settling without. */
#include "tests/testing.h"

#include "cloth/cage/coarser.h"
#include "config/base/log.h"
#include "tests/cloth/sheets.h"

#define SIDE 0.6                     /* m */
enum { SQUARES = 80, HANGING = 48 }; /* a side of the sheet that is carried, and of the one that settles */

static vec3s flat(double u, double v)
{
    return (vec3s){{(float)u, 1, (float)v}};
}

/* Waves of 3 cm, far finer than the cage's edges of 1.5 cm can follow. */
static vec3s waved(double u, double v)
{
    return (vec3s){{(float)u, (float)(1 + 0.004 * sin(2 * M_PI * u / 0.03)), (float)v}};
}

static tl_garment make_garment(vec3s (*place)(double u, double v), int squares)
{
    const struct sheet_shape shape = {.columns = squares, .rows = squares, .width = SIDE, .height = SIDE};
    return sheet_make(&shape, place);
}

static tl_cloth *make_cloth(const tl_garment *garment, const struct tl_cloth_params *params)
{
    const struct tl_cloth_fabric fabric = fabric_defaults();
    tl_error error;
    tl_cloth *cloth = tl_cloth_create(garment, &fabric, params, &error);
    assert_non_null(cloth);
    return cloth;
}

/* Turned by 1.2 about an axis that is none of the three, then moved. */
static vec3d turned(vec3d p)
{
    const vec3d axis = {2.0 / 7, 3.0 / 7, 6.0 / 7};
    double c = cos(1.2), s = sin(1.2);
    vec3d result = vec3d_add(vec3d_scale(p, c), vec3d_scale(vec3d_cross(axis, p), s));
    result = vec3d_muladd(result, axis, (1 - c) * vec3d_dot(axis, p));
    return vec3d_add(result, (vec3d){0.3, -0.2, 0.1});
}

/* A cage that moves rigidly carries every vertex by the same motion, waves and all; unmoved it leaves the
 * cloth where it is. Tolerance: the fit of the turns reads single precision. */
static void test_rigid(void **state)
{
    (void)state;
    const struct tl_cloth_params params = params_defaults();
    tl_garment garment = make_garment(waved, SQUARES);
    free(garment.pattern); /* the waves are its rest shape: without them it would be strained */
    garment.pattern = NULL;
    tl_cloth *cloth = make_cloth(&garment, &params);
    size_t count = cloth->particles.count;
    vec3d *start = TL_NEW_ARRAY(vec3d, count);
    memcpy(start, cloth->particles.x, count * sizeof *start);
    tl_coarser *coarser = tl_coarser_create(cloth, cloth->topology.vertex_count / 4);
    assert_non_null(coarser);
    tl_cloth *cage = tl_coarser_cloth(coarser);
    assert_in_range(cage->particles.count, count / 5, count / 3);
    for (int moved = 0; moved < 2; moved++) {
        double worst = 0;
        for (size_t i = 0; moved && i < cage->particles.count; i++)
            cage->particles.x[i] = turned(cage->particles.x[i]);
        tl_coarser_carry(coarser, cloth);
        for (size_t i = 0; i < count; i++)
            worst = fmax(worst, vec3d_distance(cloth->particles.x[i], moved ? turned(start[i]) : start[i]));
        assert_near(worst, 0, 1e-6);
    }
    tl_coarser_destroy(&coarser);
    tl_cloth_destroy(&cloth);
    free(start);
    sheet_free(&garment);
}

/* A pattern that is flat, of cloth that starts in waves: where the cage has come to lie flat, the waves are
 * too long for the cloth and are left out. */
static void test_folded(void **state)
{
    (void)state;
    const struct tl_cloth_params params = params_defaults();
    tl_garment garment = make_garment(waved, SQUARES);
    tl_cloth *cloth = make_cloth(&garment, &params);
    tl_coarser *coarser = tl_coarser_create(cloth, cloth->topology.vertex_count / 4);
    assert_non_null(coarser);
    tl_cloth *cage = tl_coarser_cloth(coarser);
    for (size_t i = 0; i < cage->particles.count; i++) /* the waves pressed flat */
        cage->particles.x[i].y = 1;
    tl_coarser_carry(coarser, cloth);
    for (size_t i = 0; i < cloth->particles.count; i++)
        assert_near(cloth->particles.x[i].y, 1, 1e-9);
    assert_near(tl_cloth_measure(cloth, NULL).rms_strain, 0, 1e-3);
    tl_coarser_destroy(&coarser);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* The cage weighs what the cloth weighs, is pinned where it is pinned, and is no stiffer or longer. */
static void test_same_cloth(void **state)
{
    (void)state;
    const struct tl_cloth_params params = params_defaults();
    tl_garment garment = make_garment(waved, SQUARES);
    for (uint32_t i = 0; i <= SQUARES; i++)
        sheet_pin(&garment, i);
    tl_cloth *cloth = make_cloth(&garment, &params);
    tl_coarser *coarser = tl_coarser_create(cloth, cloth->topology.vertex_count / 4);
    assert_non_null(coarser);
    tl_cloth *cage = tl_coarser_cloth(coarser);
    double mass = 0, cage_mass = 0;
    for (size_t i = 0; i < cloth->particles.count; i++)
        mass += cloth->energy.masses[i];
    for (size_t i = 0; i < cage->particles.count; i++)
        cage_mass += cage->energy.masses[i];
    assert_near(mass, SIDE * SIDE, 1e-6);
    assert_near(cage_mass, SIDE * SIDE, 1e-6);
    assert_in_range(cage->pin_count, 2, SQUARES); /* every other one at the least is enough */
    for (size_t i = 0; i < cage->pin_count; i++) {
        vec3d at = cage->particles.x[cage->pins[i].particle];
        assert_near(at.z, 0, 0); /* of the pinned border */
        assert_near(vec3d_distance(at, cage->pins[i].at), 0, 0);
        assert_true(cage->particles.w[cage->pins[i].particle] == 0);
    }
    tl_coarser_destroy(&coarser);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

/* Heights of the lowest border, strain and crossings of a settled sheet. */
struct rest {
    double hem_y, rms_strain;
    size_t crossings;
    bool settled;
};

/* A sheet that is held along one border and lies level at first: it swings down until it hangs. */
static struct rest settle_sheet(struct tl_cloth_params params, bool cages)
{
    tl_garment garment = make_garment(flat, HANGING);
    tl_error error;
    for (uint32_t i = 0; i <= HANGING; i++)
        sheet_pin(&garment, i);
    params.cages = cages;
    tl_cloth *cloth = make_cloth(&garment, &params);
    assert_ok(tl_cloth_settle(cloth, NULL, &error), error);
    const struct tl_cloth_report report = tl_cloth_measure(cloth, NULL);
    struct rest rest = {
        .rms_strain = report.rms_strain, .crossings = report.crossing_count, .settled = report.settled};
    for (uint32_t i = 0; i <= HANGING; i++)
        rest.hem_y += cloth->particles.x[HANGING * (HANGING + 1) + i].y / (HANGING + 1);
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
    return rest;
}

/* With and without cages the sheet hangs at one height. It hangs by its length and by what its weight and the
 * solver stretch it, of which the first alone is 0.6 m: a cage with other rest lengths, weight or pins would
 * leave it elsewhere, and one that is not carried would be at 1 m still. */
static void test_sheet(void **state)
{
    (void)state;
    const struct tl_cloth_params params = params_defaults();
    const struct rest with = settle_sheet(params, true), without = settle_sheet(params, false);
    assert_true(with.settled); /* without, the sheet still swings by a millimetre after ten seconds */
    assert_near(with.hem_y, without.hem_y, 1e-3);
    assert_near(with.rms_strain, without.rms_strain, 2e-3);
    assert_int_equal(with.crossings, 0);
    assert_true(with.hem_y < 1 - SIDE);
}

/* Cloth with open seams has no coarser version. */
static void test_none(void **state)
{
    (void)state;
    const struct tl_cloth_params params = params_defaults();
    tl_garment garment = make_garment(flat, SQUARES);
    sheet_seam(&garment, 0, SQUARES);
    tl_cloth *cloth = make_cloth(&garment, &params);
    assert_null(tl_coarser_create(cloth, cloth->topology.vertex_count / 4));
    tl_cloth_destroy(&cloth);
    sheet_free(&garment);
}

int main(void)
{
    tl_log_set_level(TL_LOG_WARN);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rigid), cmocka_unit_test(test_folded), cmocka_unit_test(test_same_cloth),
        cmocka_unit_test(test_none),  cmocka_unit_test(test_sheet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
