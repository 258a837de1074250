/* One option at a time: what is taken, what is refused and in which words; text and back. */
#include "tests/testing.h"

#include "config/base/memory.h"
#include "config/base/words.h"
#include "config/options.h"
#include "tests/config/sample_tables.h"

#include <locale.h>
#include <string.h>

static struct sample sample;
static struct tl_binding bindings[SAMPLE_TABLES];

static int begin(void **state)
{
    (void)state;
    memset(&sample, 0, sizeof sample);
    sample_bind(&sample, bindings);
    return 0;
}

static bool set(const char *key, const char *text, tl_error *error)
{
    return tl_options_set(bindings, SAMPLE_TABLES, key, text, "here", NULL, error);
}

static void accept(const char *key, const char *text)
{
    tl_error error = {0};
    assert_ok(set(key, text, &error), error);
}

/* Refused with exactly this message, and nothing changed. */
static void refuse(const char *key, const char *text, const char *message)
{
    struct sample before = sample;
    tl_error error = {0};
    assert_false(set(key, text, &error));
    assert_string_equal(error.message, message);
    assert_int_equal(error.code, TL_USAGE);
    assert_memory_equal(&sample, &before, sizeof sample);
}

static void test_reset_gives_defaults(void **state)
{
    (void)state;
    assert_int_equal(sample.light.regions, 96);
    assert_int_equal(sample.light.lobe, 1);
    assert_true(sample.light.softness == 0.05f && sample.light.bias_m == 0.001 && sample.light.ground);
    assert_string_equal(sample.scene.garment, "dress");
}

static void test_values_are_taken(void **state)
{
    (void)state;
    accept("light.regions", "6");
    assert_int_equal(sample.light.regions, 6);
    accept("light.regions", "+384");
    assert_int_equal(sample.light.regions, 384);
    accept("light.lobe", "single");
    assert_int_equal(sample.light.lobe, 0);
    accept("light.softness", "1e-3");
    assert_true(sample.light.softness == 1e-3f);
    accept("light.softness", "0.001"); /* the limit, which as a float lies above the double */
    accept("light.bias_m", "-.5");
    assert_true(sample.light.bias_m == -0.5);
    accept("scene.title", "a: \"b\" \\ c");
    assert_string_equal(sample.scene.title, "a: \"b\" \\ c");
    accept("scene.title", "");
    assert_string_equal(sample.scene.title, "");
}

static void test_booleans(void **state)
{
    (void)state;
    static const char *const words[][2] = {{"false", "true"}, {"no", "yes"}, {"off", "on"}};
    for (size_t i = 0; i < TL_COUNT(words); i++)
        for (int value = 0; value < 2; value++) {
            accept("light.ground", words[i][value]);
            assert_int_equal(sample.light.ground, value);
        }
    refuse("light.ground", "2", "here: light.ground: 2 is neither: expected true or false");
    refuse("light.ground", "", "here: light.ground: an empty value is neither: expected true or false");
}

#define FORMS ", \"#rrggbb\", lab(L, a, b) or a CSS name"

static void test_triples(void **state)
{
    (void)state;
    static const char *const forms[] = {"[0.1, 0.2, 1]", "0.1,0.2,1", " 0.1 , 0.2 , 1 ", "[0.1,0.2,1]"};
    for (size_t i = 0; i < TL_COUNT(forms); i++) {
        accept("scene.tint", forms[i]);
        assert_true(sample.scene.tint[0] == 0.1f && sample.scene.tint[1] == 0.2f &&
                    sample.scene.tint[2] == 1);
        accept("scene.tint", "0,0,0");
    }
    accept("scene.target", "[-1, 0, 99.5]");
    assert_true(sample.scene.target[0] == -1 && sample.scene.target[2] == 99.5f);
    refuse("scene.tint", "[0, 0]",
           "here: scene.tint: [0, 0] has fewer than three numbers: expected [r, g, b], each from 0 to 1 "
           "linear" FORMS);
    refuse("scene.tint", "0,0,0,0",
           "here: scene.tint: 0,0,0,0 has more than three numbers: expected [r, g, b], each from 0 to 1 "
           "linear" FORMS);
    refuse("scene.tint", "0,,0",
           "here: scene.tint: 0,,0 is not a number: expected [r, g, b], each from 0 to 1 linear" FORMS);
    refuse("scene.tint", "0,0,2",
           "here: scene.tint: 0,0,2 is out of range: expected [r, g, b], each from 0 to 1 linear" FORMS);
    refuse("scene.target", "[",
           "here: scene.target: [ is not a number: expected [x, y, z], each from -100 to 100 m");
}

static void test_numbers_are_refused(void **state)
{
    (void)state;
    refuse("light.regions", "7000",
           "here: light.regions: 7000 is out of range: expected a whole number from 6 to 384");
    refuse("light.regions", "99999999999999999999999",
           "here: light.regions: 99999999999999999999999 is out of range: expected a whole number from 6 to "
           "384");
    static const char *const no_integers[] = {"1.5", "96.0", "1e2", "0x60", "96 ",
                                              " 96", "96x",  "nan", "-",    "+-7"};
    for (size_t i = 0; i < TL_COUNT(no_integers); i++) {
        char *message =
            tl_format("here: light.regions: %s is not a whole number: expected a whole number from 6 to 384",
                      no_integers[i]);
        refuse("light.regions", no_integers[i], message);
        free(message);
    }
    static const char *const no_numbers[] = {"nan", "NaN", "inf",   "-inf", "infinity", "0x1p3", "1 ",
                                             " 1",  "1,5", "1.5.2", "e5",   "1e",       "--1",   "one"};
    for (size_t i = 0; i < TL_COUNT(no_numbers); i++) {
        char *message = tl_format(
            "here: light.softness: %s is not a number: expected a number from 0.001 to 10 m", no_numbers[i]);
        refuse("light.softness", no_numbers[i], message);
        free(message);
    }
    refuse("light.bias_m", "1e999",
           "here: light.bias_m: 1e999 is out of range: expected a number from -1 to 1e+12 m");
    refuse("light.softness", "10.000001",
           "here: light.softness: 10.000001 is out of range: expected a number from 0.001 to 10 m");
}

static void test_names_and_choices(void **state)
{
    (void)state;
    refuse("light.lobe", "duel",
           "here: light.lobe: duel is not one of its values: expected single, dual or triple: did you mean "
           "dual?");
    refuse("light.lobe", "1",
           "here: light.lobe: 1 is not one of its values: expected single, dual or triple");
    refuse("light.regionz", "6", "here: light.regionz: no such option: did you mean light.regions?");
    refuse("light.colour", "6",
           "here: light.colour: no such option: light has regions, lobe, softness, bias_m, ground");
    refuse("light.garment", "skirt", "here: light.garment: no such option: did you mean scene.garment?");
    refuse("lihgt.regions", "6", "here: lihgt: no such table: did you mean light?");
    refuse("physics.regions", "6", "here: physics: no such table: expected one of light, scene");
    refuse("regions", "6", "here: regions: lacks its table: did you mean light.regions?");
    refuse("", "6", "here: : lacks its table: expected table.option, as in light.regions");
    refuse(".", "6", "here: : no such table: expected one of light, scene");
    refuse("light.", "6", "here: light.: no such option: light has regions, lobe, softness, bias_m, ground");
}

static void test_paths_stand_beside_their_file(void **state)
{
    (void)state;
    static const struct {
        const char *key, *text, *base, *expected;
    } cases[] = {
        {"scene.file", "a.glb", "scenes/s.yaml", "scenes/a.glb"},
        {"scene.file", "../a.glb", "/x/s.yaml", "/x/../a.glb"},
        {"scene.file", "/abs/a.glb", "scenes/s.yaml", "/abs/a.glb"},
        {"scene.file", "a.glb", "s.yaml", "a.glb"},
        {"scene.file", "a.glb", NULL, "a.glb"},
        {"scene.file", "", "scenes/s.yaml", ""},
        {"scene.garment", "skirt", "scenes/s.yaml", "skirt"},
        {"scene.garment", "skirt.glb", "scenes/s.yaml", "scenes/skirt.glb"},
        {"scene.garment", "./skirt", "scenes/s.yaml", "scenes/./skirt"},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        tl_error error = {0};
        assert_ok(tl_options_set(bindings, SAMPLE_TABLES, cases[i].key, cases[i].text, "here", cases[i].base,
                                 &error),
                  error);
        assert_string_equal(cases[i].key[6] == 'f' ? sample.scene.file : sample.scene.garment,
                            cases[i].expected);
    }
    refuse("scene.garment", "dres",
           "here: scene.garment: dres is no name known here: expected dress, skirt, none or a file name with "
           "its "
           "extension: did you mean dress?");
}

static void test_long_and_unprintable_text(void **state)
{
    (void)state;
    char text[TL_STRING_SIZE + 1];
    memset(text, 'x', sizeof text);
    text[TL_STRING_SIZE - 1] = '\0';
    accept("scene.title", text);
    assert_string_equal(sample.scene.title, text);
    text[TL_STRING_SIZE - 1] = 'x';
    text[TL_STRING_SIZE] = '\0';
    refuse("scene.title", text, "here: scene.title: 1024 bytes are too many: expected 1023 at most");
    text[TL_STRING_SIZE - 1] = '\0';
    tl_error error = {0}; /* too long only once the folder stands before it */
    assert_false(
        tl_options_set(bindings, SAMPLE_TABLES, "scene.file", text, "here", "folder/s.yaml", &error));
    assert_non_null(strstr(error.message, "1030 bytes are too many"));

    accept("scene.title", "caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x91\x97");
    static const char *const bad[] = {
        "\xE9",             /* Latin-1 */
        "\xC0\x80",         /* overlong zero */
        "\xE0\x80\x80",     /* overlong */
        "\xED\xA0\x80",     /* surrogate */
        "\xF4\x90\x80\x80", /* beyond Unicode */
        "\xF8\x88\x80\x80\x80",
        "\xE2\x82",
        "\x80",
        "a\nb",
        "a\tb",
        "\x7F",
        "\xC2\x85",
        "\xE2\x80\xA8",
        "\xEF\xBB\xBFx",
    };
    for (size_t i = 0; i < TL_COUNT(bad); i++) {
        assert_false(set("scene.title", bad[i], &error));
        assert_non_null(strstr(error.message, "is not printable UTF-8: expected text"));
    }
}

/* However long the input, the message keeps its remedy and cuts no character in two. */
static void test_messages_stay_short(void **state)
{
    (void)state;
    char *text = tl_alloc(100001, 1);
    for (size_t i = 0; i + 2 < 100000; i += 3)
        memcpy(text + i, "\xE2\x82\xAC", 3);
    tl_error error = {0};
    assert_false(set("light.regions", text, &error));
    assert_non_null(strstr(error.message, "\xE2\x82\xAC... is not a whole number: expected a whole number"));
    assert_false(set(text, "1", &error));
    assert_non_null(strstr(error.message, "lacks its table"));
    free(text);
}

static void test_assignments(void **state)
{
    (void)state;
    tl_error error = {0};
    assert_ok(tl_options_set_assignment(bindings, SAMPLE_TABLES, "light.regions=12", &error), error);
    assert_int_equal(sample.light.regions, 12);
    assert_ok(tl_options_set_assignment(bindings, SAMPLE_TABLES, "scene.title=a=b", &error), error);
    assert_string_equal(sample.scene.title, "a=b");
    assert_false(tl_options_set_assignment(bindings, SAMPLE_TABLES, "light.regions", &error));
    assert_string_equal(error.message, "--set: light.regions: has no value: expected table.option=value");
    assert_false(tl_options_set_assignment(bindings, SAMPLE_TABLES, "=", &error));
    assert_false(tl_options_set_assignment(bindings, SAMPLE_TABLES, "", &error));
}

/* Every value, read back from its own text, has the same bits; the text is the shortest that does so. */
static void test_text_and_back(void **state)
{
    (void)state;
    refuse("light.softness", "1e-45",
           "here: light.softness: 1e-45 is out of range: expected a number from 0.001 to 10 m");
    static const double values[] = {
        0, -0.0, 0.1, 1.0 / 3, 1e-300, 4.9e-324, 123456789.125, 1e12, 0.30000000000000004};
    for (size_t i = 0; i < TL_COUNT(values); i++) {
        sample.light.bias_m = values[i];
        char *text = tl_options_get_text(&bindings[0], &sample_light_rows[3]);
        sample.light.bias_m = 7;
        accept("light.bias_m", text);
        assert_memory_equal(&sample.light.bias_m, &values[i], sizeof values[i]);
        free(text);
    }
    static const float floats[] = {0.1f, 1.0f / 3, 0.001f, 9.999999f, 0.05f};
    for (size_t i = 0; i < TL_COUNT(floats); i++) {
        sample.light.softness = floats[i];
        char *text = tl_options_get_text(&bindings[0], &sample_light_rows[2]);
        sample.light.softness = 7;
        accept("light.softness", text);
        assert_memory_equal(&sample.light.softness, &floats[i], sizeof floats[i]);
        free(text);
    }
    char *text = tl_options_get_text(&bindings[0], &sample_light_rows[2]);
    assert_string_equal(text, "0.05");
    free(text);
    text = tl_options_get_text(&bindings[1], &sample_scene_rows[0]);
    assert_string_equal(text, "[1, 0.5, 0.25]");
    free(text);
}

/* A difference in any one option is seen; what lies between the fields is not looked at, and texts are
 * compared, not pointers. */
static void test_equality(void **state)
{
    static const char *const others[][2] = {
        {"light.regions", "7"},       {"light.lobe", "single"}, {"light.softness", "3"},
        {"light.bias_m", "3"},        {"light.ground", "off"},  {"scene.tint", "1,0.5,0.3"},
        {"scene.target", "0,0,1e-3"}, {"scene.title", "x"},     {"scene.file", "x.glb"},
        {"scene.garment", "none"},
    };
    struct sample twin;
    memset(&twin, 0xAA, sizeof twin); /* other padding */
    struct tl_binding twin_bindings[SAMPLE_TABLES];
    sample_bind(&twin, twin_bindings);
    char dress[] = "dress";
    sample.scene.garment = dress;
    sample.scene.title = NULL; /* as "" */
    assert_true(tl_options_equal(&sample_light_table, &sample.light, &twin.light));
    assert_true(tl_options_equal(&sample_scene_table, &sample.scene, &twin.scene));
    for (size_t i = 0; i < TL_COUNT(others); i++) {
        begin(state);
        accept(others[i][0], others[i][1]);
        bool same = tl_options_equal(&sample_light_table, &sample.light, &twin.light) &&
                    tl_options_equal(&sample_scene_table, &sample.scene, &twin.scene);
        assert_false(same);
    }
}

/* 0.5 stays 0.5 where the locale writes 0,5. The locale may not be installed: then a made-up one will not do,
 * and the test says so. */
static void test_any_locale(void **state)
{
    (void)state;
    static const char *const commas[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8"};
    const char *set_to = NULL;
    for (size_t i = 0; i < TL_COUNT(commas) && !set_to; i++)
        set_to = setlocale(LC_NUMERIC, commas[i]);
    if (!set_to) {
        printf("skipped: no locale with a decimal comma is installed\n");
        skip();
    }
    accept("light.softness", "0.5");
    assert_true(sample.light.softness == 0.5f);
    char *text = tl_options_get_text(&bindings[0], &sample_light_rows[2]);
    setlocale(LC_NUMERIC, "C");
    assert_string_equal(text, "0.5");
    free(text);
}

static void test_nearest_word(void **state)
{
    (void)state;
    static const char *const words[] = {"regions", "map_size", "lobe", "filter"};
    static const struct {
        const char *word, *nearest;
    } cases[] = {
        {"regions", "regions"},                /* 0 */
        {"region", "regions"},                 /* deletion */
        {"regoins", "regions"},                /* swap of neighbours counts once */
        {"mapsize", "map_size"},               /* insertion */
        {"lob", "lobe"},                       /* short words: one slip */
        {"lboe", "lobe"},        {"lo", NULL}, /* two slips in four letters are no slip */
        {"pattern", NULL},       {"", NULL},
        {"filtr", "filter"},     {"fiXXer", "filter"}, /* two of six: a third */
        {"fXXXer", NULL},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        const char *nearest = tl_nearest_word(cases[i].word, words, TL_COUNT(words));
        if (cases[i].nearest) {
            assert_non_null(nearest);
            assert_string_equal(nearest, cases[i].nearest);
        } else
            assert_null(nearest);
    }
    assert_null(tl_nearest_word("x", words, 0));
}

static char *printed(void (*print)(const struct tl_binding *, size_t, FILE *))
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    print(bindings, SAMPLE_TABLES, out);
    fclose(out);
    return text;
}

static void test_help_and_reference(void **state)
{
    (void)state;
    accept("light.regions", "48");
    accept("scene.title", "two words");
    char *help = printed(tl_options_print_help);
    assert_non_null(strstr(help, "light: how it is lit\n"));
    assert_non_null(strstr(help,
                           "  light.regions=48                     more regions: sharper shadows (a whole "
                           "number from 6 to 384)\n"));
    assert_non_null(strstr(help, "scene.title='two words'"));
    free(help);

    char *reference = printed(tl_options_print_reference); /* tells the defaults, not the present values */
    assert_non_null(strstr(reference, "## light\n\nhow it is lit\n"));
    assert_non_null(strstr(reference,
                           "| `light.regions` | 96 | a whole number from 6 to 384 | more regions: sharper "
                           "shadows |\n"));
    assert_non_null(strstr(reference, " a \\| bar, and more |\n"));
    free(reference);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_reset_gives_defaults, begin),
        cmocka_unit_test_setup(test_values_are_taken, begin),
        cmocka_unit_test_setup(test_booleans, begin),
        cmocka_unit_test_setup(test_triples, begin),
        cmocka_unit_test_setup(test_numbers_are_refused, begin),
        cmocka_unit_test_setup(test_names_and_choices, begin),
        cmocka_unit_test_setup(test_paths_stand_beside_their_file, begin),
        cmocka_unit_test_setup(test_long_and_unprintable_text, begin),
        cmocka_unit_test_setup(test_messages_stay_short, begin),
        cmocka_unit_test_setup(test_assignments, begin),
        cmocka_unit_test_setup(test_text_and_back, begin),
        cmocka_unit_test_setup(test_equality, begin),
        cmocka_unit_test_setup(test_any_locale, begin),
        cmocka_unit_test(test_nearest_word),
        cmocka_unit_test_setup(test_help_and_reference, begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
