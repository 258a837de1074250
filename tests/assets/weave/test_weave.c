/* Woven detail: heights against closed forms, normals against finite differences of the heights, interlacing
 * patterns against their definitions, scale, periodicity. */
#include "tests/testing.h"

#include "assets/weave/weave.h"

#include "config/base/memory.h"

static const int patterns[] = {TL_WEAVE_PLAIN, TL_WEAVE_TWILL, TL_WEAVE_SATIN};

/* Unequal pitches reveal swapped axes; the tints identify the yarn on top. */
static struct tl_weave_params params_of(int pattern)
{
    return (struct tl_weave_params){.pattern = pattern,
                                    .warp_pitch_mm = 0.4f,
                                    .weft_pitch_mm = 0.5f,
                                    .crimp_mm = 0.12f,
                                    .warp_gloss = 0.1f,
                                    .weft_gloss = -0.2f,
                                    .warp_tint = {1, 0.5f, 0.25f},
                                    .weft_tint = {0.125f, 0.25f, 0.5f},
                                    .texels_per_yarn = 64};
}

static int wrapped(int index, int size)
{
    return (index % size + size) % size;
}

static double height_at(const tl_weave *weave, int column, int row)
{
    int side = weave->height.width;
    return (double)tl_image_floats(&weave->height)[wrapped(row, side) * side + wrapped(column, side)];
}

static bool warp_on_top(const tl_weave *weave, int column, int row)
{
    int side = weave->tint.width;
    return tl_image_floats(&weave->tint)[3 * (size_t)(wrapped(row, side) * side + wrapped(column, side))] ==
           1;
}

static double normal_component(const tl_weave *weave, int column, int row, int component)
{
    int side = weave->normal.width;
    return 2 *
           (tl_image_bytes(&weave->normal)[3 * (size_t)(row * side + column) + (size_t)component] / 255.0 -
            0.5);
}

static void test_scale(void **state)
{
    (void)state;
    const int repeats[] = {2, 4, 5};
    for (size_t i = 0; i < TL_COUNT(patterns); i++) {
        struct tl_weave_params params = params_of(patterns[i]);
        tl_weave weave;
        assert_true(tl_weave_create(&params, &weave));
        assert_near(weave.size_m[0], repeats[i] * 0.4e-3, 1e-9);
        assert_near(weave.size_m[1], repeats[i] * 0.5e-3, 1e-9);
        assert_int_equal(weave.normal.width, repeats[i] * 64);
        assert_int_equal(weave.height.height, repeats[i] * 64);
        assert_true(weave.normal.linear && weave.normal.type == TL_IMAGE_U8);
        tl_weave_release(&weave);
        assert_null(weave.normal.texels);
    }
    struct tl_weave_params none = params_of(TL_WEAVE_NONE);
    tl_weave weave;
    assert_false(tl_weave_create(&none, &weave));
}

/* At the middle of every crossing the yarn on top is at its crest: height crimp. The middle lies between four
 * texels, half a texel away on both axes: the section's ellipse falls by crimp/2 (1 - sqrt(1 -
 * (1/128/0.56)^2)) = 1e-4 crimp/2 there, the cosine by 3e-4 of it; 1e-3 crimp covers both. Nothing is higher
 * than the crest. */
static void test_crests(void **state)
{
    (void)state;
    const double crimp = 0.12e-3;
    for (size_t i = 0; i < TL_COUNT(patterns); i++) {
        struct tl_weave_params params = params_of(patterns[i]);
        tl_weave weave;
        assert_true(tl_weave_create(&params, &weave));
        int side = weave.height.width;
        for (int row = 32; row < side; row += 64) {
            for (int column = 32; column < side; column += 64)
                assert_near(height_at(&weave, column, row), crimp, 1e-3 * crimp);
        }
        for (int row = 0; row < side; row++) {
            for (int column = 0; column < side; column++)
                assert_true(height_at(&weave, column, row) <= crimp &&
                            height_at(&weave, column, row) > -crimp);
        }
        tl_weave_release(&weave);
    }
}

/* The share of the weave's crossings with the warp on top, and their order: plain 1 of 2, chequered; twill 3
 * of 4, each row of the pattern (a pick) one end to the right of the row below; satin 4 of 5, no two weft
 * crossings adjacent, not even by a corner. */
static void test_interlacing(void **state)
{
    (void)state;
    const int repeats[] = {2, 4, 5}, warp_crossings[] = {2, 12, 20};
    for (size_t i = 0; i < TL_COUNT(patterns); i++) {
        struct tl_weave_params params = params_of(patterns[i]);
        tl_weave weave;
        assert_true(tl_weave_create(&params, &weave));
        int over = 0, n = repeats[i];
        for (int pick = 0; pick < n; pick++) {
            for (int end = 0; end < n; end++) {
                int column = end * 64 + 32, row = (n - 1 - pick) * 64 + 32;
                bool warp = warp_on_top(&weave, column, row);
                over += warp;
                bool right = warp_on_top(&weave, column + 64, row);
                bool up_right = warp_on_top(&weave, column + 64, row - 64);
                bool up_left = warp_on_top(&weave, column - 64, row - 64);
                if (patterns[i] == TL_WEAVE_TWILL)
                    assert_int_equal(warp, up_right);
                if (patterns[i] == TL_WEAVE_PLAIN)
                    assert_int_equal(warp, !right);
                if (patterns[i] == TL_WEAVE_SATIN && !warp)
                    assert_true(right && up_right && up_left);
            }
        }
        assert_int_equal(over, warp_crossings[i]);
        tl_weave_release(&weave);
    }
}

/* Away from kinks (where another yarn comes on top, or neighbours touch), the normal's slopes are central
 * differences of the height, also across the map's border. The difference's own error is h^2/6 f''': with h =
 * pitch / 64 and the ellipse's third derivative where neighbours touch (x = 0.89: 3x / (1-x^2)^2.5 = 145 in
 * units of thickness / half-width^3) it is 0.0034 / 0.37 of slope 0.27, below 0.01; coding in 8 bits adds
 * 0.004 on a component, up to 0.008 on a slope of one. */
static void test_normals_match_heights(void **state)
{
    (void)state;
    for (size_t i = 0; i < 2 * TL_COUNT(patterns); i++) {
        struct tl_weave_params params = params_of(patterns[i / 2]);
        params.section = i % 2 ? TL_YARN_FLAT : TL_YARN_ROUND;
        tl_weave weave;
        assert_true(tl_weave_create(&params, &weave));
        int side = weave.height.width, checked = 0;
        double step_x = (double)weave.size_m[0] / side, step_y = (double)weave.size_m[1] / side;
        for (int row = 0; row < side; row++) {
            for (int column = 0; column < side; column++) {
                bool warp = warp_on_top(&weave, column, row);
                bool kink = warp != warp_on_top(&weave, column - 1, row) ||
                            warp != warp_on_top(&weave, column + 1, row) ||
                            warp != warp_on_top(&weave, column, row - 1) ||
                            warp != warp_on_top(&weave, column, row + 1);
                int across = (warp ? column : row) % 64;
                /* A neighbour that runs higher covers 0.06 pitches, 3.8 texels; a difference reaches one
                 * more. */
                kink |= across < 5 || across > 58;
                if (kink)
                    continue;
                double slope_x =
                    (height_at(&weave, column + 1, row) - height_at(&weave, column - 1, row)) / (2 * step_x);
                double slope_y =
                    (height_at(&weave, column, row - 1) - height_at(&weave, column, row + 1)) / (2 * step_y);
                double scale = 1 / sqrt(1 + slope_x * slope_x + slope_y * slope_y);
                assert_near(normal_component(&weave, column, row, 0), -slope_x * scale, 0.015);
                assert_near(normal_component(&weave, column, row, 1), -slope_y * scale, 0.015);
                assert_near(normal_component(&weave, column, row, 2), scale, 0.015);
                checked++;
            }
        }
        assert_true(checked > side * side * 3 / 4);
        tl_weave_release(&weave);
    }
}

/* The maps tile: heights are as continuous across the border as within. The largest step between neighbours
 * within bounds the step across. */
static void test_periodic(void **state)
{
    (void)state;
    for (size_t i = 0; i < TL_COUNT(patterns); i++) {
        struct tl_weave_params params = params_of(patterns[i]);
        tl_weave weave;
        assert_true(tl_weave_create(&params, &weave));
        int side = weave.height.width;
        double inner = 0, border = 0;
        for (int k = 0; k < side; k++) {
            for (int n = 0; n < side; n++) {
                double step = fmax(fabs(height_at(&weave, n, k) - height_at(&weave, n + 1, k)),
                                   fabs(height_at(&weave, k, n) - height_at(&weave, k, n + 1)));
                if (n == side - 1)
                    border = fmax(border, step);
                else
                    inner = fmax(inner, step);
            }
        }
        assert_true(border <= inner * 1.0001);
        tl_weave_release(&weave);
    }
}

/* The cloth is flat on average: yarns are symmetric, so the mean normal is vertical, within half an 8-bit
 * step and the asymmetry of the valleys of an uneven pattern. */
static void test_mean_is_flat(void **state)
{
    (void)state;
    for (size_t i = 0; i < TL_COUNT(patterns); i++) {
        struct tl_weave_params params = params_of(patterns[i]);
        tl_weave weave;
        assert_true(tl_weave_create(&params, &weave));
        double mean[3] = {0};
        int side = weave.normal.width;
        for (int row = 0; row < side; row++) {
            for (int column = 0; column < side; column++) {
                for (int c = 0; c < 3; c++)
                    mean[c] += normal_component(&weave, column, row, c) / (side * side);
            }
        }
        assert_near(mean[0], 0, 0.005);
        assert_near(mean[1], 0, 0.005);
        assert_true(mean[2] > 0.8 && mean[2] < 1);
        tl_weave_release(&weave);
    }
}

/* Gloss and tint are those of the yarn on top, without blending. */
static void test_yarn_values(void **state)
{
    (void)state;
    struct tl_weave_params params = params_of(TL_WEAVE_SATIN);
    tl_weave weave;
    assert_true(tl_weave_create(&params, &weave));
    int side = weave.gloss.width;
    for (int k = 0; k < side * side; k++) {
        float gloss = tl_image_floats(&weave.gloss)[k];
        const float *tint = tl_image_floats(&weave.tint) + 3 * (size_t)k;
        bool warp = gloss == 0.1f;
        assert_true(warp || gloss == -0.2f);
        assert_true(tint[0] == (warp ? 1 : 0.125f) && tint[1] == (warp ? 0.5f : 0.25f) &&
                    tint[2] == (warp ? 0.25f : 0.5f));
    }
    tl_weave_release(&weave);
}

/* No crimp at all: flat yarns, no division by zero. */
/* A quarter of a pitch from the middle of a warp yarn that is on top, a parabola lies below the ellipse. */
static void test_sections(void **state)
{
    (void)state;
    struct tl_weave_params params = params_of(TL_WEAVE_PLAIN);
    tl_weave round, flat;
    assert_true(tl_weave_create(&params, &round));
    params.section = TL_YARN_FLAT;
    assert_true(tl_weave_create(&params, &flat));
    const double x = 16.5 / 64 / 0.56, rise = 1 - x * x;
    assert_true(warp_on_top(&flat, 48, 32));
    assert_near(height_at(&round, 48, 32) - height_at(&flat, 48, 32), 0.06e-3 * (sqrt(rise) - rise), 1e-9);
    tl_weave_release(&round);
    tl_weave_release(&flat);
}

static void test_flat_cloth(void **state)
{
    (void)state;
    struct tl_weave_params params = params_of(TL_WEAVE_PLAIN);
    params.crimp_mm = 0;
    params.texels_per_yarn = 16;
    tl_weave weave;
    assert_true(tl_weave_create(&params, &weave));
    for (int row = 0; row < 32; row++) {
        for (int column = 0; column < 32; column++) {
            assert_true(height_at(&weave, column, row) == 0);
            assert_near(normal_component(&weave, column, row, 2), 1, 1e-9);
        }
    }
    tl_weave_release(&weave);
}

/* Sums of deviations begin and end with 0; no yarn deviates by more than its system's share of the amount and
 * of what neighbours add to it; a satin's warp, which lies on top, varies most. */
static void test_streaks(void **state)
{
    (void)state;
    struct tl_weave_params params = params_of(TL_WEAVE_SATIN);
    params.streaks = 0.2f;
    tl_weave weave;
    assert_true(tl_weave_create(&params, &weave));
    assert_near(weave.yarns->pitch_m[0], 0.4e-3, 1e-9);
    assert_near(weave.yarns->pitch_m[1], 0.5e-3, 1e-9);
    const int counts[2] = {TL_WARP_YARNS, TL_WEFT_YARNS}, firsts[2] = {0, TL_WARP_YARNS + 1};
    const double shares[2] = {0.8, 0.2};
    for (int k = 0; k < 2; k++) {
        const float *sums = weave.yarns->sums + firsts[k];
        double square = 0, maximum = 0;
        assert_near(sums[0], 0, 0);
        assert_near(sums[counts[k]], 0, 0);
        for (int i = 0; i < counts[k]; i++) {
            const double deviation = (double)(sums[i + 1] - sums[i]);
            square += deviation * deviation / counts[k];
            maximum = fmax(maximum, fabs(deviation));
        }
        const double amount = shares[k] * 0.2;
        print_message("system %d: root mean square %.4f, at most %.4f\n", k, sqrt(square), maximum);
        assert_true(maximum < 1.4 * amount);
        /* of what is even between -1 and 1 a third of the square; neighbours add less than half as much */
        assert_true(sqrt(square) > 0.5 * amount && sqrt(square) < 0.7 * amount);
    }
    tl_weave_release(&weave);
    params.streaks = 0;
    assert_true(tl_weave_create(&params, &weave));
    assert_null(weave.yarns);
    tl_weave_release(&weave);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scale),
        cmocka_unit_test(test_streaks),
        cmocka_unit_test(test_crests),
        cmocka_unit_test(test_interlacing),
        cmocka_unit_test(test_normals_match_heights),
        cmocka_unit_test(test_periodic),
        cmocka_unit_test(test_mean_is_flat),
        cmocka_unit_test(test_yarn_values),
        cmocka_unit_test(test_sections),
        cmocka_unit_test(test_flat_cloth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
