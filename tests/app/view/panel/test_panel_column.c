/* The panel's column, which is kept as a texture: it is drawn again when its drawing differs or the glyphs
 * have another texture, and only then. */
#include "tests/app/view/panel/column_shim.h"

#include "tests/testing.h"

static void the_column_is_renewed_when_it_differs(void **state)
{
    (void)state;
    tl_error error = {0};
    tl_gpu *gpu = tl_gpu_create_headless(&error);
    assert_ok(gpu != NULL, error);
    struct column_stage *stage = column_begin(gpu);
    for (int i = 0; i < 3; i++) /* ImGui shows a new window from its second frame on */
        column_show(stage, "17 ms");
    const unsigned first = column_show(stage, "17 ms"), same = column_show(stage, "17 ms");
    const unsigned other = column_show(stage, "18 ms, 25 %");
    assert_true(first > 0);
    assert_int_equal(same, first);
    assert_int_not_equal(other, first);
    assert_int_equal(column_show(stage, "17 ms"), first);
    /* What is kept does not show what happens to the glyphs: nothing was drawn. */
    column_fill_glyphs(stage, false);
    assert_int_equal(column_show(stage, "17 ms"), first);
    /* With another texture it is drawn again. */
    column_fill_glyphs(stage, true);
    assert_int_not_equal(column_show(stage, "17 ms"), first);
    column_end(&stage);
    assert_int_equal(tl_gpu_message_count(gpu), 0);
    tl_gpu_destroy(&gpu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_column_is_renewed_when_it_differs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
