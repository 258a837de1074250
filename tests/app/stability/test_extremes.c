/* The rules of `toile stability`: nothing above the stated share is called bounded, and wide bounds name
 * remedies. */
#include "config/base/log.h"
#include "config/base/memory.h"
#include "tests/app/stability/extremes_light.h"
#include "tests/app/stability/outcome.h"
#include "tests/testing.h"

#include <math.h>

static void test_outcomes(void **state)
{
    (void)state;
    assert_int_equal(tl_outcome_of(0.0005, 0.001, 0.08), TL_OUTCOME_EXACT);
    assert_int_equal(tl_outcome_of(0.05, 0.001, 0.08), TL_OUTCOME_BOUNDED);
    assert_int_equal(tl_outcome_of(0.30, 0.001, 0.08), TL_OUTCOME_SILENT); /* above its own bound */
    assert_int_equal(tl_outcome_of(0.25, 0.001, 2), TL_OUTCOME_BOUNDED);
    assert_int_equal(tl_outcome_of(0.30, 0.001, 2), TL_OUTCOME_COARSE);
    assert_int_equal(tl_outcome_of(2.1, 0.001, 2), TL_OUTCOME_SILENT);
    assert_int_equal(tl_outcome_of(INFINITY, 0.001, 2), TL_OUTCOME_SILENT);
    assert_int_equal(tl_outcome_of(NAN, 0.001, 2), TL_OUTCOME_NAN);
}

/* A cell whose judge is wrong is counted as silent all the same. */
static void test_counts(void **state)
{
    (void)state;
    static const struct {
        enum tl_outcome judged;
        double share;
        enum tl_outcome counted;
    } cells[] = {
        {TL_OUTCOME_BOUNDED, 0.24, TL_OUTCOME_BOUNDED}, {TL_OUTCOME_BOUNDED, 0.30, TL_OUTCOME_SILENT},
        {TL_OUTCOME_EXACT, 0.30, TL_OUTCOME_SILENT},    {TL_OUTCOME_BOUNDED, NAN, TL_OUTCOME_SILENT},
        {TL_OUTCOME_COARSE, 0.30, TL_OUTCOME_COARSE},   {TL_OUTCOME_REFUSED, NAN, TL_OUTCOME_REFUSED},
    };
    struct tl_stability stability = {.rows = cJSON_CreateArray()};
    for (size_t i = 0; i < TL_COUNT(cells); i++) {
        const struct tl_cell_error error = {.share = cells[i].share, .own = 1, .unit = "mm"};
        int before = stability.counts[cells[i].counted];
        const cJSON *row = tl_stability_add(&stability, "test", cells[i].judged, &error);
        assert_int_equal(stability.counts[cells[i].counted], before + 1);
        assert_string_equal(cJSON_GetObjectItem(row, "outcome")->valuestring,
                            tl_outcome_names[cells[i].counted]);
        assert_string_equal(cJSON_GetObjectItem(row, "unit")->valuestring, "mm");
        if (isfinite(cells[i].share))
            assert_true(fabs(cJSON_GetObjectItem(row, "error_percent")->valuedouble - 100 * cells[i].share) <
                        1e-9);
    }
    assert_int_equal(tl_stability_cells(&stability), (int)TL_COUNT(cells));
    cJSON_Delete(stability.rows);
}

/* A bound above the stated share, or one that is not a number, names a remedy. */
static void test_remedies(void **state)
{
    (void)state;
    for (size_t i = 0; i < tl_extreme_count; i++)
        for (int m = 0; m < TL_EXTREME_METHODS; m++) {
            double bound = tl_extremes[i].bounds[m];
            if (bound > TL_STATED_SHARE && !tl_extremes[i].remedies[m])
                fail_msg("%s: a bound of %g and no remedy", tl_extremes[i].name, bound);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_outcomes), cmocka_unit_test(test_counts),
                                       cmocka_unit_test(test_remedies)};
    tl_log_set_level(TL_LOG_WARN);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
