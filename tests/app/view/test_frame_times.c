/* Frame times against a sorted list of all of them. */
#include "app/view/window/frame_times.h"

#include "tests/testing.h"

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void quantiles_of_all(void **state)
{
    (void)state;
    enum { COUNT = 5000 };
    static double all[COUNT];
    struct tl_frame_times times = {0};
    assert_near(tl_frame_times_quantile(&times, 0.5), 0, 0);
    for (int i = 0; i < COUNT; i++) {
        double x = fmod(0.61803398875 * (i + 1), 1);
        all[i] = 2 * exp(6 * x * x);
        tl_frame_times_add(&times, all[i]);
    }
    qsort(all, COUNT, sizeof *all, compare);
    const double shares[] = {0.5, 0.95, 0.99, 1};
    for (size_t i = 0; i < 4; i++) {
        double exact = all[(int)(shares[i] * COUNT) - 1];
        assert_near(tl_frame_times_quantile(&times, shares[i]), exact, 0.0101 * exact); /* a bin's width */
    }
    assert_near(times.worst_ms, all[COUNT - 1], 0);
}

static void the_last_in_order(void **state)
{
    (void)state;
    struct tl_frame_times times = {0};
    for (int i = 0; i < 10; i++)
        tl_frame_times_add(&times, i);
    assert_int_equal(times.count, 10);
    assert_near(tl_frame_times_at(&times, 0), 0, 0);
    for (int i = 10; i < 3 * TL_FRAME_TIMES_SHOWN + 7; i++)
        tl_frame_times_add(&times, i);
    assert_int_equal(times.count, TL_FRAME_TIMES_SHOWN);
    for (int i = 0; i < TL_FRAME_TIMES_SHOWN; i++)
        assert_near(tl_frame_times_at(&times, (size_t)i), 2 * TL_FRAME_TIMES_SHOWN + 7 + i, 0);
}

/* Times beyond the bins, at either end, are still counted. */
static void extremes(void **state)
{
    (void)state;
    struct tl_frame_times times = {0};
    tl_frame_times_add(&times, 0);
    tl_frame_times_add(&times, 1e9);
    assert_int_equal(times.total, 2);
    assert_true(tl_frame_times_quantile(&times, 0.5) <= 0.0102);
    assert_true(tl_frame_times_quantile(&times, 1) > 2e5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantiles_of_all),
        cmocka_unit_test(the_last_in_order),
        cmocka_unit_test(extremes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
