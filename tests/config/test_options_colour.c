/* Colours as text: every form gives the same numbers, and what is wrong is refused with what was expected. */
#include "tests/testing.h"

#include "config/base/memory.h"
#include "config/colour/srgb.h"
#include "config/options.h"
#include "tests/config/sample_tables.h"

#include <stdio.h>
#include <string.h>

#define EXPECTED "expected [r, g, b], each from 0 to 1 linear, \"#rrggbb\", lab(L, a, b) or a CSS name"

static struct sample sample;
static struct tl_binding bindings[SAMPLE_TABLES];

static int begin(void **state)
{
    (void)state;
    memset(&sample, 0, sizeof sample);
    sample_bind(&sample, bindings);
    return 0;
}

static void accept(const char *text, const float rgb[3], double tolerance)
{
    tl_error error = {0};
    begin(NULL);
    assert_ok(tl_options_set(bindings, SAMPLE_TABLES, "scene.tint", text, "here", NULL, &error), error);
    for (int c = 0; c < 3; c++)
        assert_near(sample.scene.tint[c], rgb[c], tolerance);
}

/* Refused with exactly this message, and nothing changed. */
static void refuse(const char *text, const char *fault, const char *remedy)
{
    const struct sample before = sample;
    tl_error error = {0};
    char *message = tl_format("here: scene.tint: %s %s: " EXPECTED "%s", text[0] ? text : "an empty value",
                              fault, remedy);
    assert_false(tl_options_set(bindings, SAMPLE_TABLES, "scene.tint", text, "here", NULL, &error));
    assert_string_equal(error.message, message);
    assert_int_equal(error.code, TL_USAGE);
    assert_memory_equal(&sample, &before, sizeof sample);
    free(message);
}

static void test_hex(void **state)
{
    (void)state;
    float rgb[3];
    tl_srgb_decode(0xC8102E, rgb);
    accept("#c8102e", rgb, 0);
    accept("#C8102E", rgb, 0);
    tl_srgb_decode(0xAA11FF, rgb);
    accept("#a1f", rgb, 0);
    static const char *const bad[] = {"#",        "#ab",     "#abcd",   "#abcde",
                                      "#abcdefa", "#abcdeg", "#-12345", "# abcde"};
    for (size_t i = 0; i < TL_COUNT(bad); i++)
        refuse(bad[i], "does not have three or six hexadecimal digits", "");
}

/* sRGB's primaries and Munsell's middle grey by their published CIELAB [Lindbloom, D65], which has two
 * digits after the point: at the steepest, 0.01 of L, a or b is 1e-3 of a channel. */
static void test_lab(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        float rgb[3];
    } known[] = {{"lab(53.24, 80.09, 67.20)", {1, 0, 0}},          {"Lab 87.74 -86.18 83.18", {0, 1, 0}},
                 {"LAB( 32.30 79.19 -107.86 )", {0, 0, 1}},        {"lab(100,0,0)", {1, 1, 1}},
                 {"lab 50, 0, 0", {0.18419f, 0.18419f, 0.18419f}}, {"lab(0 0 0)", {0, 0, 0}}};
    for (size_t i = 0; i < TL_COUNT(known); i++) {
        accept(known[i].text, known[i].rgb, 2e-3);
        char *remark = tl_option_remark(&sample_scene_rows[0], known[i].text);
        assert_null(remark); /* digits that are rounded out of the gamut are not worth a warning */
    }
    static const char *const bad[] = {"lab(50, 0)",   "lab(50, 0, 0, 0)", "lab(50, 0, 0",
                                      "lab 50 0 0)",  "lab(50,,0)",       "lab()",
                                      "lab(nan 0 0)", "lab(50%, 0, 0)",   "lab(5, 0, 0) x"};
    for (size_t i = 0; i < TL_COUNT(bad); i++)
        refuse(bad[i], "is not lab(L, a, b)", "");
    static const char *const far[] = {"lab(101, 0, 0)", "lab(-1, 0, 0)", "lab(50, 129, 0)",
                                      "lab(50, 0, -129)", "lab(1e300, 0, 0)"};
    for (size_t i = 0; i < TL_COUNT(far); i++)
        refuse(far[i], "is out of range: L is from 0 to 100, a and b are from -128 to 128", "");
}

/* What Rec. 709 cannot show is taken as the nearest of its hue, and the remark states both and their
 * difference. */
static void test_beyond_the_gamut(void **state)
{
    (void)state;
    tl_error error = {0};
    const char *text = "lab(60, 90, 50)";
    assert_ok(tl_options_set(bindings, SAMPLE_TABLES, "scene.tint", text, "here", NULL, &error), error);
    char *remark = tl_option_remark(&sample_scene_rows[0], text), hex[8] = "";
    double l, a, b, difference;
    assert_non_null(remark);
    assert_int_equal(
        sscanf(remark,
               "lab(60, 90, 50) is more saturated than a screen shows (Rec. 709): it is drawn as "
               "lab(%lf, %lf, %lf), %7s, a difference of %lf (CIEDE2000)",
               &l, &a, &b, hex, &difference),
        5);
    assert_near(l, 60, 0.05);
    assert_near(a * 50, b * 90, 90 * 0.05 + 50 * 0.05); /* the hue, of numbers with one digit */
    assert_true(a < 90 && difference > 1);
    assert_memory_equal(hex, tl_hex_of(sample.scene.tint).text, 7);
    free(remark);
    assert_null(tl_option_remark(&sample_scene_rows[0], "navy"));
    assert_null(tl_option_remark(&sample_scene_rows[2], text)); /* a text is not a colour */
}

static void test_names(void **state)
{
    (void)state;
    float rgb[3];
    tl_srgb_decode(0x556B2F, rgb);
    accept("darkolivegreen", rgb, 0);
    accept("Dark olive-green", rgb, 0);
    refuse("darkolivgreen", "is no name of a colour", ": did you mean darkolivegreen?");
    refuse("Nvay", "is no name of a colour", ": did you mean navy?");
    refuse("puce", "is no name of a colour", "");
    refuse("none", "is no name of a colour", "");
    refuse("nan,0,0", "is no name of a colour", "");
    refuse("", "is no colour (in a file, # begins a comment unless it is quoted)", "");
}

/* In a file: quoted hex, lists, CIELAB with and without commas, names; # without quotes is explained. */
static void test_files(void **state)
{
    (void)state;
    static const struct {
        const char *yaml;
        uint32_t rgb; /* 1 << 24: refused */
    } cases[] = {{"scene: {tint: \"#c8102e\"}\n", 0xC8102E},
                 {"scene:\n  tint: '#C8102E' # Pantone 186\n", 0xC8102E},
                 {"scene: {tint: [1, 0, 0]}\n", 0xFF0000},
                 {"scene: {tint: lab(53.24 80.09 67.20)}\n", 0xFF0000},
                 {"scene:\n  tint: lab(53.24, 80.09, 67.20)\n", 0xFF0000},
                 {"scene: {tint: navy}\n", 0x000080},
                 {"scene:\n  tint: #c8102e\n", 1 << 24}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        tl_error error = {0};
        begin(NULL);
        bool read = tl_options_read_yaml(bindings, SAMPLE_TABLES, "s.yaml", cases[i].yaml,
                                         strlen(cases[i].yaml), &error);
        assert_int_equal(read, cases[i].rgb <= 0xFFFFFF);
        if (read)
            assert_int_equal(tl_srgb_encode(sample.scene.tint), cases[i].rgb);
        else
            assert_string_equal(error.message,
                                "s.yaml:2: scene.tint: an empty value is no colour (in a file, # "
                                "begins a comment unless it is quoted): " EXPECTED);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_hex, begin),
        cmocka_unit_test_setup(test_lab, begin),
        cmocka_unit_test_setup(test_beyond_the_gamut, begin),
        cmocka_unit_test_setup(test_names, begin),
        cmocka_unit_test_setup(test_files, begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
