/* The list of keys stays within the view, whatever the window's size: neither its first letters nor its last
 * ones are cut off, and it does not cover the panel. */
#include "app/view/command/review_commands.h"
#include "config/base/memory.h"
#include "tests/app/view/panel/overlay_shim.h"
#include "tests/testing.h"

static void help_stays_within_the_view(void **state)
{
    (void)state;
    enum { ROWS = 128 };
    static struct tl_panel_line rows[ROWS];
    static const int sizes[][3] = {{1280, 800, 380}, {1920, 1080, 380}, {1000, 700, 380}, {800, 500, 0}};
    size_t count = tl_review_help(rows, ROWS);
    assert_in_range(count, 40, ROWS - 1);
    for (size_t i = 0; i < TL_COUNT(sizes); i++) {
        const int *size = sizes[i];
        struct overlay_place at = overlay_draw_help(rows, count, size[0], size[1], size[2]);
        print_message("%d x %d, panel %d: x %.0f to %.0f, y %.0f to %.0f\n", size[0], size[1], size[2],
                      (double)at.left, (double)at.right, (double)at.top, (double)at.bottom);
        assert_true(at.left >= 0 && at.right <= (float)(size[0] - size[2]));
        assert_true(at.top >= 0 && at.bottom <= (float)size[1]);
        assert_true(at.right - at.left > 0.4f * (float)(size[0] - size[2])); /* it is there */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(help_stays_within_the_view)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
