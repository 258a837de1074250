/* The panel's fonts: an atlas that holds every code point that was noted and that one of the system's fonts
 * has. */
#include "tests/app/view/panel/glyphs_shim.h"

#include "tests/testing.h"

#include "app/view/panel/panel_font_shim.h"

static void the_atlas_grows_with_the_texts(void **state)
{
    (void)state;
    const char *const latin = "\u00c9t\u00e9 bleu \u2014 15\u00b0", *const korean = "\uc6d0\ud53c\uc2a4.glb";
    glyphs_begin();
    tl_panel_fonts *fonts = tl_panel_fonts_create(15, 1);
    assert_int_equal(glyphs_missing(latin), 0);
    tl_panel_fonts_note(fonts, latin);
    tl_panel_fonts_note(fonts, NULL);
    assert_false(tl_panel_fonts_update(fonts)); /* nothing new: the atlas stays */
    int without = glyphs_missing(korean), texels = glyphs_atlas_texels();
    assert_int_equal(without, 3);
    tl_panel_fonts_note(fonts, korean);
    assert_true(tl_panel_fonts_update(fonts));
    int with = glyphs_missing(korean);
    assert_int_equal(glyphs_missing(latin), 0);
    assert_true(glyphs_atlas_texels() <= 4 * texels); /* three glyphs, not all of Korean */
    tl_panel_fonts_note(fonts, korean);
    assert_false(tl_panel_fonts_update(fonts));                  /* whether or not a font has them */
    tl_panel_fonts_note(fonts, "\xff\xfe\xc3 \xf0\x9f\x91\x97"); /* no UTF-8; a code point above 16 bits */
    tl_panel_fonts_update(fonts);
    assert_int_equal(glyphs_missing(latin), 0);
    tl_panel_fonts_destroy(&fonts);
    glyphs_end();
    if (with == without) {
        printf("skipped: no font here has Korean letters: install fonts-nanum\n");
        skip();
    }
    assert_int_equal(with, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_atlas_grows_with_the_texts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
