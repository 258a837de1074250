/* The lobes of the page of `toile trade --axis light`: what [Knuth et al. 2014, figures 4 and 5] state and
 * what the page measures agree, but for the paper's percentages. */
#include "tests/testing.h"

#include "app/lab/trade/trade_light.h"

#include <string.h>

static void figures_4_and_5_agree_with_the_paper(void **state)
{
    (void)state;
    cJSON *figures = cJSON_CreateArray();
    tl_trade_add_lobes(true, figures);
    const cJSON *items = cJSON_GetObjectItem(cJSON_GetArrayItem(figures, 0), "items");
    assert_int_equal(cJSON_GetArraySize(items), 4); /* two figures, the second in two measures, and a table */
    for (int i = 0; i < 3; i++)
        assert_string_equal(
            cJSON_GetObjectItem(
                cJSON_GetArrayItem(cJSON_GetObjectItem(cJSON_GetArrayItem(items, i), "series"), 0), "name")
                ->valuestring,
            "MIP map only");
    const char *text = cJSON_GetObjectItem(cJSON_GetArrayItem(items, 1), "caption")->valuestring;
    print_message("%s\n", text);
    assert_non_null(strstr(text, "no reading"));
    assert_null(strstr(text, "not"));
    cJSON_Delete(figures);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(figures_4_and_5_agree_with_the_paper)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
