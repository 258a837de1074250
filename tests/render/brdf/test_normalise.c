#include "render/brdf/normalise.h"

#include "config/base/memory.h"

#include "tests/testing.h"

#define DEG (M_PI / 180)

static void exact_is_unit_and_zero_stays_zero(void **state)
{
    (void)state;
    struct tl_normal_cube cube = tl_normal_cube_make(4, 8);
    for (int method = 0; method < TL_NORMALISE_COUNT; method++)
        assert_near(glms_vec3_norm(tl_normalise(method, &cube, (vec3s){{0, 0, 0}})), 0, 0);
    vec3s unit = tl_normalise(TL_NORMALISE_EXACT, &cube, (vec3s){{3, -4, 12}});
    assert_near(glms_vec3_norm(unit), 1, 1e-6);
    tl_normal_cube_release(&cube);
    struct tl_normalise_error error = tl_normalise_error(TL_NORMALISE_EXACT, 60 * DEG);
    assert_true(error.vector < 1e-6 && error.length < 1e-6);
}

/* In the middle of the arc linear interpolation has the length x = cos(angle/2); the series makes it x (1 -
 * y/2 + 3/8 y^2 - 5/16 y^3), y = x^2 - 1 [Schroecker 2002, eq. 5], of which Newton's step is x/2 (3 - x^2).
 * None turns the vector. */
static void lengths_are_the_closed_forms(void **state)
{
    (void)state;
    for (int degrees = 5; degrees <= 90; degrees += 5) {
        double x = cos(degrees * DEG / 2);
        struct tl_normalise_error none = tl_normalise_error(TL_NORMALISE_NONE, degrees * DEG);
        struct tl_normalise_error newton = tl_normalise_error(TL_NORMALISE_NEWTON, degrees * DEG);
        assert_near(none.length, 1 - x, 1e-6);
        assert_near(newton.length, 1 - x / 2 * (3 - x * x), 1e-6);
        double y = x * x - 1, length = x * (1 - y / 2);
        for (int i = 0; i < 2; i++) {
            length += x * (i ? -5.0 / 16 * y * y * y : 3.0 / 8 * y * y);
            struct tl_normalise_error error = tl_normalise_error(TL_NORMALISE_TAYLOR2 + i, degrees * DEG);
            assert_near(error.length, 1 - length, 1e-6);
            assert_true(error.direction < 1e-6);
        }
        assert_true(none.direction < 1e-6 && newton.direction < 1e-6);
    }
}

/* Range compressed to n bits, a component is off by at most 1/(2^n - 1) and in the mean by a root of three
 * less; three of them make 1/(2^n - 1), which interpolation between texels can only lower. */
static void cube_maps_err_by_their_rounding(void **state)
{
    (void)state;
    struct tl_normalise_error eight = tl_normalise_error(TL_NORMALISE_CUBE8, 20 * DEG);
    struct tl_normalise_error sixteen = tl_normalise_error(TL_NORMALISE_CUBE16, 20 * DEG);
    assert_true(eight.vector > 0.4 / 255 && eight.vector < 1.0 / 255);
    assert_true(eight.length < sqrt(3.0) / 255 && eight.direction < sqrt(3.0) / 255);
    assert_true(sixteen.vector < 3e-5); /* texels 0.6 mrad apart leave the chord: 256 a side */
}

static void newton_beats_eight_bits_up_to_an_angle(void **state)
{
    (void)state;
    double single = tl_normalise_limit(TL_NORMALISE_NEWTON, TL_NORMALISE_CUBE8) / DEG;
    double fixed = tl_normalise_limit(TL_NORMALISE_NEWTON8, TL_NORMALISE_CUBE8) / DEG;
    printf("Newton's step beats the 8-bit cube map up to %.1f degrees between vertices, in 8+1 bits up to "
           "%.1f\n",
           single, fixed);
    assert_true(single > 30 && single < 60);
    assert_true(fixed > 20 && fixed <= single);
    for (int degrees = 1; degrees < 30; degrees += 4)
        assert_true(tl_normalise_error(TL_NORMALISE_NEWTON, degrees * DEG).vector <
                    tl_normalise_error(TL_NORMALISE_CUBE8, degrees * DEG).vector);
}

/* 16 bits: nearer by two orders, and as good as exact in a highlight of 8 bits. */
static void sixteen_bits_are_nearly_exact(void **state)
{
    (void)state;
    const int angles[] = {5, 15, 30, 45, 60, 90};
    printf("rms distance from the unit vector / largest error of a highlight of n = 8, by angle between "
           "vertices\n%-13s",
           "");
    for (size_t i = 0; i < TL_COUNT(angles); i++)
        printf("  %13d deg", angles[i]);
    printf("\n");
    for (int method = 0; method < TL_NORMALISE_COUNT; method++) {
        printf("%-13s", tl_normalisation_names[method]);
        for (size_t i = 0; i < TL_COUNT(angles); i++) {
            struct tl_normalise_error error = tl_normalise_error(method, angles[i] * DEG);
            printf("  %.1e / %.1e", error.vector, error.highlight);
        }
        printf("\n");
    }
    for (size_t i = 0; i < TL_COUNT(angles); i++) {
        struct tl_normalise_error eight = tl_normalise_error(TL_NORMALISE_CUBE8, angles[i] * DEG);
        struct tl_normalise_error sixteen = tl_normalise_error(TL_NORMALISE_CUBE16, angles[i] * DEG);
        struct tl_normalise_error exact = tl_normalise_error(TL_NORMALISE_EXACT, angles[i] * DEG);
        assert_true(sixteen.vector < eight.vector / 50);
        assert_near(sixteen.highlight, exact.highlight, 0.5 / 255);
        assert_near(sixteen.slerp, exact.slerp, 1e-4);
    }
}

/* The error that no normalisation removes: linear interpolation is faster in the middle of the arc. Its
 * angle at position p is off by up to about angle^3 / 124, the maximum of atan((2p - 1) tan(a/2)) - (2p -
 * 1) a/2. */
static void slerp_differs_by_the_third_power(void **state)
{
    (void)state;
    for (int degrees = 20; degrees <= 60; degrees += 20) {
        double a = degrees * DEG, maximum = 0;
        for (int i = 0; i <= 1000; i++) {
            double p = 2 * i / 1000.0 - 1;
            maximum = fmax(maximum, fabs(atan(p * tan(a / 2)) - p * a / 2));
        }
        double slerp = tl_normalise_error(TL_NORMALISE_EXACT, a).slerp;
        assert_true(slerp < maximum && slerp > maximum / 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_is_unit_and_zero_stays_zero),
        cmocka_unit_test(lengths_are_the_closed_forms),
        cmocka_unit_test(cube_maps_err_by_their_rounding),
        cmocka_unit_test(newton_beats_eight_bits_up_to_an_angle),
        cmocka_unit_test(sixteen_bits_are_nearly_exact),
        cmocka_unit_test(slerp_differs_by_the_third_power),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
