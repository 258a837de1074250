#include "render/brdf/power.h"

#include "config/base/memory.h"

#include "tests/testing.h"

static void pow_is_the_baseline(void **state)
{
    (void)state;
    struct tl_power_error error = tl_power_error(TL_POWER_POW, 64, TL_POWER_TABLE_SIZE);
    assert_near(error.max, 0, 0);
    assert_near(error.band, 1.0 / 255, 1e-9);
    assert_true(error.levels >= 255); /* the sweep ends on the border to level 0 */
}

/* All 256 cosines against the powers of their own rounding: each squaring rounds to half a level, and the
 * next doubles what came before at most. */
static void fixed_point_rounds_at_each_squaring(void **state)
{
    (void)state;
    assert_near(register_power(1, 8), 1, 0);
    assert_near(register_power(0, 3), 0, 0);
    assert_near(register_power(NAN, 3), 0, 0);
    for (int squarings = 1; squarings <= 8; squarings++) {
        for (int i = 0; i <= 255; i++) {
            double exact = pow(i / 255.0, 1 << squarings), bound = 0;
            for (int k = 0; k < squarings; k++)
                bound = 2 * bound * pow(i / 255.0, 1 << k) + 0.5 / 255 + bound * bound;
            float value = register_power((float)i / 255, squarings);
            assert_near(value, exact, bound + 1e-6);
            assert_near(fabs(round((double)value * 255) - (double)value * 255), 0, 1e-4);
        }
    }
}

/* Between two values a line stands for the power: it is off by n (n - 1) x^(n - 2) h^2 / 8, most where x is
 * 1, and the values' rounding adds half a level. */
static void the_table_is_weak_near_one(void **state)
{
    (void)state;
    for (int n = 8; n <= 256; n *= 2) {
        for (int size = 64; size <= 1024; size *= 4) {
            struct tl_power_error error = tl_power_error(TL_POWER_TABLE, n, size);
            double chord = 0, h = 1.0 / (size - 1), low = pow(1 - h, n);
            for (int i = 0; i <= 1000; i++) /* over the last two values */
                chord = fmax(chord, low + (1 - low) * i / 1000.0 - pow(1 - h + h * i / 1000.0, n));
            assert_near(error.max_near_one, chord, 0.55 / 255);
            assert_near(error.max, error.max_near_one, 1.1 / 255);
        }
    }
}

static void banding_grows_with_the_exponent(void **state)
{
    (void)state;
    struct tl_power_error before = {.levels = 257};
    printf("   n      fixed8: levels  band    rms     most |  table of 256: levels  band    rms     most   "
           "(near 1)\n");
    for (int n = 8; n <= 256; n *= 2) {
        struct tl_power_error fixed = tl_power_error(TL_POWER_FIXED8, n, TL_POWER_TABLE_SIZE);
        struct tl_power_error table = tl_power_error(TL_POWER_TABLE, n, TL_POWER_TABLE_SIZE);
        printf("%4d %20d  %.4f  %.4f  %.4f | %21d  %.4f  %.4f  %.4f  %.4f\n", n, fixed.levels, fixed.band,
               fixed.rms, fixed.max, table.levels, table.band, table.rms, table.max, table.max_near_one);
        assert_true(fixed.levels < before.levels && fixed.band > before.band);
        /* No more levels than there are different cosines in the highlight. */
        assert_true(fixed.levels <= 255 * (1 - pow(0.5 / 255, 1.0 / n)) + 2);
        /* From one cosine to the next: 1 - (254/255)^n, and what rounding adds. */
        assert_true(fixed.band >= 1 - pow(254.0 / 255, n) - 0.5 / 255);
        assert_true(table.band <= 1.01 / 255 && table.levels > 200 && table.rms < fixed.rms);
        before = fixed;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pow_is_the_baseline),
        cmocka_unit_test(fixed_point_rounds_at_each_squaring),
        cmocka_unit_test(the_table_is_weak_near_one),
        cmocka_unit_test(banding_grows_with_the_exponent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
