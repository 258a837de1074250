/* Every figure of the gallery is a plot or more, of finite numbers, and its caption has what was measured. */
#include "tests/testing.h"

#include "app/lab/gallery/gallery_figures.h"
#include "config/base/memory.h"

#include <string.h>

static void expect_finite(const cJSON *item)
{
    const cJSON *child;
    assert_false(cJSON_IsNull(item));
    cJSON_ArrayForEach(child, item) expect_finite(child);
}

static void figures_are_plots(void **state)
{
    (void)state;
    static const struct {
        const char *section;
        int plots, series; /* of the first plot */
        const char *part;
    } all[] = {{"a1", 2, 6, "Tables in float"},
               {"a2", 1, 3, "divided by its greatest value"},
               {"a3", 1, 4, "shading.table_terms=all"},
               {"a9", 1, 5, "beats the cube map of 8 bits up to 38 degrees"},
               {"a10", 3, 3, "it has 6 levels"},
               {"b6", 1, 2, "index 200"},
               {"d8", 0, 0, "[\"128\",18,"}, /* a table: 24 x 6 x 128^2 x 8 bytes are 18 MiB */
               {"d9", 0, 0, "[]"}};
    for (size_t i = 0; i < TL_COUNT(all); i++) {
        cJSON *figures = cJSON_CreateArray();
        tl_gallery_add_figures(all[i].section, figures);
        int plots = 0;
        for (int k = 0; k < cJSON_GetArraySize(figures); k++) {
            const cJSON *series = cJSON_GetObjectItem(cJSON_GetArrayItem(figures, k), "series"), *one;
            plots += series != NULL;
            if (k == 0)
                assert_int_equal(cJSON_GetArraySize(series), all[i].series);
            cJSON_ArrayForEach(one, series)
                assert_true(cJSON_GetArraySize(cJSON_GetObjectItem(one, "points")) > 4);
        }
        assert_int_equal(plots, all[i].plots);
        expect_finite(figures);
        char *text = cJSON_PrintUnformatted(figures);
        assert_non_null(strstr(text, all[i].part));
        cJSON_free(text);
        cJSON_Delete(figures);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(figures_are_plots)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
