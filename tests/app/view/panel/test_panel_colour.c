/* The row of a colour in the panel: its chip has the colour as the screen shows it, and what is typed is
 * taken as the option takes it, once, when typing ends. */
#include "tests/testing.h"

#include "config/colour/srgb.h"
#include "tests/app/view/panel/colours_shim.h"

#include <string.h>

struct dye {
    float colour[3];
};
static const struct tl_option rows[] = {
    TL_OPTION_COLOUR(struct dye, colour, TL_AFFECTS_NOTHING, 0, 1, "of the cloth")};
static const struct tl_option_table table =
    TL_OPTION_TABLE("dye", "colours", rows, struct dye, .colour = {0.5f, 0.25f, 0.125f});

static struct dye dye;
static const struct tl_binding binding = {&table, &dye};

static int begin(void **state)
{
    (void)state;
    tl_options_reset(&binding, 1);
    return 0;
}

static void the_chip_has_the_colour(void **state)
{
    (void)state;
    tl_srgb_decode(0x3B7A57, dye.colour);
    assert_true(colours_chip_has(&binding, &rows[0], 0x3B7A57));
    assert_false(colours_chip_has(&binding, &rows[0], 0x3B7A58));
}

static void typed_colours_are_taken(void **state)
{
    static const struct {
        const char *text;
        enum colours_end end;
        uint32_t rgb;
    } cases[] = {{"#c8102e", COLOURS_ENTER, 0xC8102E},
                 {"navy", COLOURS_CLICK_BESIDE, 0x000080},
                 {"navy", COLOURS_CLICK_BEFORE, 0x000080},
                 {"lab(53.24, 80.09, 67.20)", COLOURS_ENTER, 0xFF0000},
                 {"1, 1, 1", COLOURS_ENTER, 0xFFFFFF}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct tl_panel_result result;
        begin(state);
        colours_type(&binding, &rows[0], cases[i].text, cases[i].end, &result);
        assert_true(result.changed);
        assert_int_equal(tl_srgb_encode(dye.colour), cases[i].rgb);
        assert_int_equal(result.note.error.code, TL_OK);
        assert_string_equal(result.note.remark, "");
    }
}

/* Neither the hex of the present colour nor a text that is given up rounds it to 8 bits. */
static void what_is_not_meant_changes_nothing(void **state)
{
    (void)state;
    const struct dye before = dye;
    struct tl_panel_result result;
    colours_type(&binding, &rows[0], "navy", COLOURS_ESCAPE, &result);
    assert_false(result.changed);
    colours_type(&binding, &rows[0], tl_hex_of(dye.colour).text, COLOURS_ENTER, &result);
    assert_false(result.changed);
    assert_int_equal(result.note.error.code, TL_OK);
    assert_memory_equal(&dye, &before, sizeof dye);
}

static void slips_and_the_gamut_are_reported(void **state)
{
    (void)state;
    const struct dye before = dye;
    struct tl_panel_result result;
    colours_type(&binding, &rows[0], "nvay", COLOURS_ENTER, &result);
    assert_false(result.changed);
    assert_memory_equal(&dye, &before, sizeof dye);
    assert_int_equal(result.note.error.code, TL_USAGE);
    assert_non_null(strstr(result.note.error.message, "dye.colour: nvay"));
    assert_non_null(strstr(result.note.error.message, "did you mean navy?"));
    colours_type(&binding, &rows[0], "lab(60, 90, 50)", COLOURS_ENTER, &result);
    assert_true(result.changed);
    assert_non_null(strstr(result.note.remark, "lab(60, 90, 50) is more saturated"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(the_chip_has_the_colour, begin),
        cmocka_unit_test_setup(typed_colours_are_taken, begin),
        cmocka_unit_test_setup(what_is_not_meant_changes_nothing, begin),
        cmocka_unit_test_setup(slips_and_the_gamut_are_reported, begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
