#include "assets/base/units.h"

#include "tests/testing.h"

#include "config/base/memory.h"

#include <string.h>

static struct tl_box box_of_size(float x, float y, float z)
{
    return (struct tl_box){{{-x / 2, 1, -z / 2}}, {{x / 2, 1 + y, z / 2}}};
}

static struct tl_units_reading read_tall(float tall)
{
    return tl_units_read(box_of_size(tall / 2, tall, tall / 4), TL_UNITS_AUTO, false);
}

/* The rows of the table in assets/base/units.h, and its borders from both sides. */
static void units_are_guessed_from_sizes(void **state)
{
    (void)state;
    static const struct {
        float longest;
        enum tl_units units, other;
        bool fits;
    } rows[] = {
        {0.01f, TL_UNITS_M, TL_UNITS_AUTO, false}, {0.249f, TL_UNITS_M, TL_UNITS_AUTO, false},
        {0.251f, TL_UNITS_M, TL_UNITS_AUTO, true}, {1.7f, TL_UNITS_M, TL_UNITS_AUTO, true},
        {2.49f, TL_UNITS_M, TL_UNITS_AUTO, true},  {2.51f, TL_UNITS_DM, TL_UNITS_AUTO, true},
        {9.8f, TL_UNITS_DM, TL_UNITS_AUTO, true},  {9.9f, TL_UNITS_IN, TL_UNITS_DM, true},
        {24.9f, TL_UNITS_IN, TL_UNITS_DM, true},   {25.1f, TL_UNITS_CM, TL_UNITS_IN, true},
        {60, TL_UNITS_CM, TL_UNITS_IN, true},      {98.3f, TL_UNITS_CM, TL_UNITS_IN, true},
        {98.5f, TL_UNITS_CM, TL_UNITS_AUTO, true}, {170, TL_UNITS_CM, TL_UNITS_AUTO, true},
        {249, TL_UNITS_CM, TL_UNITS_AUTO, true},   {251, TL_UNITS_MM, TL_UNITS_AUTO, true},
        {812, TL_UNITS_MM, TL_UNITS_AUTO, true},   {2490, TL_UNITS_MM, TL_UNITS_AUTO, true},
        {2510, TL_UNITS_MM, TL_UNITS_AUTO, false}, {1e30f, TL_UNITS_MM, TL_UNITS_AUTO, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        struct tl_units_reading reading = read_tall(rows[i].longest);
        if (reading.units != rows[i].units || reading.other != rows[i].other || reading.fits != rows[i].fits)
            print_error("%g units: %s, %s, %d\n", (double)rows[i].longest, tl_units_names[reading.units],
                        tl_units_names[reading.other], reading.fits);
        assert_int_equal(reading.units, rows[i].units);
        assert_int_equal(reading.other, rows[i].other);
        assert_int_equal(reading.fits, rows[i].fits);
        assert_true(reading.guessed);
    }
}

/* A guess that fits gives the size of a garment in metres, and so does the second guess. */
static void fitting_guesses_have_garment_sizes(void **state)
{
    (void)state;
    for (int i = 0; i < 1600; i++) {
        struct tl_units_reading reading = read_tall(0.01f * powf(1.01f, (float)i)); /* to 8e4 */
        double metres = (double)reading.longest * tl_units_metres(reading.units);
        assert_int_equal(reading.fits, metres >= 0.25 && metres < 2.5);
        if (reading.other != TL_UNITS_AUTO) {
            double other_m = (double)reading.longest * tl_units_metres(reading.other);
            assert_true(other_m >= 0.25 * (1 - 1e-6) && other_m < 2.5);
        }
    }
}

static void stated_units_are_used(void **state)
{
    (void)state;
    struct tl_box tall = box_of_size(400, 812, 100), small = box_of_size(0.005f, 0.005f, 0.005f);
    assert_int_equal(tl_units_read(tall, TL_UNITS_IN, false).units, TL_UNITS_IN);
    assert_false(tl_units_read(tall, TL_UNITS_IN, false).guessed);
    assert_int_equal(tl_units_read(small, TL_UNITS_AUTO, true).units, TL_UNITS_M); /* glTF, a swatch */
    assert_int_equal(tl_units_read(box_of_size(10, 20, 10), TL_UNITS_AUTO, true).units, TL_UNITS_M);
    assert_int_equal(tl_units_read(tall, TL_UNITS_AUTO, true).units, TL_UNITS_MM); /* glTF, but absurd */
    assert_null(tl_units_describe("a.glb", &(struct tl_units_reading){.units = TL_UNITS_M}, ""));
}

static void guesses_are_reported(void **state)
{
    (void)state;
    struct tl_units_reading reading = read_tall(812);
    char *line = tl_units_describe("skirt.obj", &reading, "--units");
    assert_string_equal(line, "skirt.obj: 812 units at its longest: taken as millimetres (0.812 m); --units "
                              "overrides this");
    free(line);
    reading = read_tall(60);
    line = tl_units_describe("skirt.obj", &reading, "--units");
    assert_non_null(strstr(line, "centimetres (0.6 m), though inches are possible"));
    free(line);
    reading = read_tall(0.1f);
    line = tl_units_describe("skirt.obj", &reading, "--units");
    assert_non_null(strstr(line, "no unit fits: taken as metres"));
    free(line);
    reading = tl_units_read(box_of_size(400, 812, 100), TL_UNITS_AUTO, true);
    line = tl_units_describe("a.glb", &reading, "scene.avatar_units");
    assert_string_equal(line,
                        "a.glb: 812 units at its longest: absurd as metres: taken as millimetres (0.812 m); "
                        "scene.avatar_units overrides this");
    free(line);
}

/* A person along Z with feet at z = 0, and with arms spread; panels around one with its waist at z = 0; then
 * upright ones: a person, a wide skirt, a garment in front of the origin. */
static void models_along_z_are_detected(void **state)
{
    (void)state;
    const struct tl_box lying = {{{-0.3f, -0.15f, 0}}, {{0.3f, 0.15f, 1.7f}}};
    const struct tl_box spread = {{{-0.85f, -0.15f, 0}}, {{0.85f, 0.15f, 1.7f}}};
    const struct tl_box panels = {{{-0.33f, -0.1f, -0.2f}}, {{0.32f, 0.2f, 0.58f}}};
    const struct tl_box upright = {{{-0.3f, 0, -0.15f}}, {{0.3f, 1.7f, 0.15f}}};
    const struct tl_box skirt = {{{-0.5f, 0.7f, -0.5f}}, {{0.5f, 1, 0.5f}}};
    const struct tl_box before = {{{-0.3f, 1, 1}}, {{0.3f, 1.4f, 2}}};
    assert_true(tl_units_read(lying, TL_UNITS_M, false).z_up);
    assert_true(tl_units_read(spread, TL_UNITS_AUTO, false).z_up);
    assert_true(tl_units_read(panels, TL_UNITS_AUTO, false).z_up);
    assert_false(tl_units_read(lying, TL_UNITS_AUTO, true).z_up); /* glTF says which way is up */
    assert_false(tl_units_read(upright, TL_UNITS_AUTO, false).z_up);
    assert_false(tl_units_read(skirt, TL_UNITS_AUTO, false).z_up);
    assert_false(tl_units_read(before, TL_UNITS_AUTO, false).z_up);
}

/* A dress from 27 to 63 units high, and with its arms up from 27 to 51: a person's in inches, either way. One
 * that stands on the ground stays in centimetres. A shirt of 209 square units is one in decimetres, not a
 * doll's in inches, spread or folded. What is set stays. */
static void poses_have_one_size(void **state)
{
    (void)state;
    const struct {
        struct tl_box box;
        double area;
        enum tl_units wanted, expected;
    } cases[] = {
        {{{{12, 26.5f, -10}}, {{35, 62.8f, 12}}}, 3180, TL_UNITS_AUTO, TL_UNITS_IN},
        {{{{12, 26.7f, -10}}, {{35, 51.1f, 12}}}, 2400, TL_UNITS_AUTO, TL_UNITS_IN},
        {{{{-12, 0, -10}}, {{12, 36.3f, 12}}}, 3180, TL_UNITS_AUTO, TL_UNITS_CM},
        {{{{-5, 1.2f, -3}}, {{5, 12.6f, 3}}}, 209, TL_UNITS_AUTO, TL_UNITS_DM},
        {{{{-5, -4, -3}}, {{5, 4, 3}}}, 209, TL_UNITS_AUTO, TL_UNITS_DM},
        {{{{-8, -4, -3}}, {{8, 4, 3}}}, 700, TL_UNITS_AUTO, TL_UNITS_IN},
        {{{{-5, 1.2f, -3}}, {{5, 12.6f, 3}}}, 209, TL_UNITS_IN, TL_UNITS_IN},
        {{{{-5, 1.2f, -3}}, {{5, 12.6f, 3}}}, 0, TL_UNITS_AUTO, TL_UNITS_IN},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        struct tl_units_reading reading = tl_units_read(cases[i].box, cases[i].wanted, false);
        tl_units_weigh(&reading, cases[i].box, cases[i].area);
        assert_int_equal(reading.units, cases[i].expected);
        assert_true(reading.other != reading.units);
    }
}

/* A skirt of 0.5 by 0.25 by 0.37 m on a body whose waist is 1 m above the ground, with Z up: as wide as it is
 * deep, it shows no axis by itself. With Y up, and beside the body, nothing is said. */
static void a_body_shows_the_axis(void **state)
{
    (void)state;
    const struct tl_box body = {{{-0.65f, 0, -0.15f}}, {{0.65f, 1.72f, 0.15f}}};
    const struct tl_box lying = {{{-0.25f, -0.2f, 0.9f}}, {{0.25f, 0.17f, 1.15f}}};
    const struct tl_box upright = {{{-0.25f, 0.9f, -0.17f}}, {{0.25f, 1.15f, 0.2f}}};
    const struct tl_box beside = {{{1.25f, -0.2f, 0.9f}}, {{1.75f, 0.17f, 1.15f}}};
    assert_false(tl_units_read(lying, TL_UNITS_M, false).z_up);
    assert_true(tl_units_lies_z_up(lying, body));
    assert_false(tl_units_lies_z_up(upright, body));
    assert_false(tl_units_lies_z_up(beside, body));
    assert_true(tl_units_lies_y_up(upright, body));
    assert_false(tl_units_lies_y_up(lying, body));
    const struct tl_box shoes = {{{-0.25f, 0, -0.05f}}, {{0.25f, 0.12f, 0.1f}}}; /* within it either way */
    assert_false(tl_units_lies_z_up(shoes, body));
}

/* One unit that fits is no question, two are, and so is none, and metres that cannot be; an axis is one where
 * the model is deeper than high, if its format does not state it. */
static void what_is_in_doubt(void **state)
{
    (void)state;
    static const struct {
        float height, depth; /* units */
        enum tl_units wanted;
        bool is_metric;
        unsigned doubts;
    } cases[] = {
        {1.2f, 0.5f, TL_UNITS_AUTO, false, 0},
        {140, 50, TL_UNITS_AUTO, false, 0}, /* centimetres: inches would be 3.6 m */
        {812, 300, TL_UNITS_AUTO, false, 0},
        {36, 20, TL_UNITS_AUTO, false, TL_DOUBT_UNITS}, /* or inches */
        {36, 20, TL_UNITS_CM, false, 0},
        {0.1f, 0.05f, TL_UNITS_AUTO, false, TL_DOUBT_UNITS}, /* no unit fits */
        {0.1f, 0.05f, TL_UNITS_AUTO, true, 0},
        {1200, 500, TL_UNITS_AUTO, true, TL_DOUBT_UNITS}, /* as metres, absurd */
        {0.5f, 1.2f, TL_UNITS_AUTO, false, TL_DOUBT_UP},
        {0.5f, 0.6f, TL_UNITS_AUTO, false, TL_DOUBT_UP}, /* a wide skirt, which is left as it is */
        {0.5f, 0.6f, TL_UNITS_AUTO, true, 0},
        {20, 50, TL_UNITS_AUTO, false, TL_DOUBT_UNITS | TL_DOUBT_UP},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        struct tl_box box = box_of_size(0.9f * cases[i].height, cases[i].height, cases[i].depth);
        struct tl_units_reading reading = tl_units_read(box, cases[i].wanted, cases[i].is_metric);
        assert_int_equal(tl_units_doubts(&reading), cases[i].doubts);
        char *line = tl_units_describe_up("skirt.obj", &reading, "--up");
        assert_int_equal(line != NULL, (cases[i].doubts & TL_DOUBT_UP) != 0);
        assert_true(!line || strstr(line, "--up"));
        free(line);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(units_are_guessed_from_sizes), cmocka_unit_test(fitting_guesses_have_garment_sizes),
        cmocka_unit_test(stated_units_are_used),        cmocka_unit_test(guesses_are_reported),
        cmocka_unit_test(models_along_z_are_detected),  cmocka_unit_test(poses_have_one_size),
        cmocka_unit_test(a_body_shows_the_axis),        cmocka_unit_test(what_is_in_doubt),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
