/* Extremes of cloth that `toile stability cloth --quick` leaves out, since they are slow. */
#include "app/lab/stability/extremes_cloth.h"
#include "cloth/cloth.h"
#include "config/log.h"
#include "tests/testing.h"

#include <string.h>

static size_t extreme_named(const char *name)
{
    for (size_t i = 0; i < tl_cloth_extreme_count; i++)
        if (strcmp(tl_cloth_extreme_name(i), name) == 0)
            return i;
    fail_msg("no extreme is named %s", name);
    return 0;
}

/* Its long substeps make what is known of contacts old within a few of them: cloth that slides on itself then
 * never stopped. */
static void test_rest(void **state)
{
    (void)state;
    tl_error found = {0};
    enum tl_outcome outcome =
        tl_cloth_extreme_run(extreme_named("at rest on a ball"), TL_CLOTH_SETTLE, &found);
    printf("at rest on a ball, settle: %s %s\n", tl_outcome_names[outcome], found.message);
    assert_int_equal(outcome, TL_OUTCOME_BOUNDED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_rest)};
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
