/* The gallery's walls as data: all rows of the technique set hang, and every exhibit's options exist. */
#include "tests/testing.h"

#include "app/lab/gallery/gallery.h"
#include "app/scene/settings.h"
#include "config/memory.h"

#include <string.h>

static bool hangs(const char *id)
{
    for (size_t w = 0; w < tl_gallery_wall_count; w++)
        for (size_t e = 0; e < tl_gallery_walls[w].exhibit_count; e++)
            if (strcmp(tl_gallery_walls[w].exhibits[e].id, id) == 0)
                return true;
    return false;
}

static void test_all_rows_hang(void **state)
{
    (void)state;
    static const struct {
        char group;
        int count;
    } groups[] = {{'A', 12}, {'B', 7}, {'C', 8}};
    for (size_t g = 0; g < TL_COUNT(groups); g++)
        for (int i = 1; i <= groups[g].count; i++) {
            char id[16];
            snprintf(id, sizeof id, "%c%d", groups[g].group, i);
            if (!hangs(id))
                fail_msg("%s hangs nowhere", id);
        }
    assert_true(hangs("D9"));
}

static size_t append(const char **all, size_t count, const char *const *list, size_t most)
{
    for (size_t i = 0; i < most && list[i]; i++)
        all[count++] = list[i];
    return count;
}

static void test_every_option_exists(void **state)
{
    (void)state;
    for (size_t w = 0; w < tl_gallery_wall_count; w++) {
        const struct tl_gallery_wall *wall = &tl_gallery_walls[w];
        for (size_t e = 0; e < wall->exhibit_count; e++) {
            const char *all[4 * TL_GALLERY_ASSIGNMENTS];
            size_t count = append(all, 0, wall->base, TL_COUNT(wall->base));
            count = append(all, count, wall->exhibits[e].chosen, TL_COUNT(wall->exhibits[e].chosen));
            count = append(all, count, wall->exact, TL_COUNT(wall->exact));
            count = append(all, count, wall->exhibits[e].exact, TL_COUNT(wall->exhibits[e].exact));
            const struct tl_settings_source source = {"gallery", all, count};
            struct tl_settings settings;
            tl_error error = {0};
            assert_ok(tl_settings_load(&settings, &source, &error), error);
        }
    }
}

/* Files are called after their walls. */
static void test_names_differ(void **state)
{
    (void)state;
    for (size_t w = 0; w < tl_gallery_wall_count; w++)
        for (size_t other = 0; other < w; other++)
            assert_string_not_equal(tl_gallery_walls[w].name, tl_gallery_walls[other].name);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_rows_hang),
        cmocka_unit_test(test_every_option_exists),
        cmocka_unit_test(test_names_differ),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
