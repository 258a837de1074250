/* CIELAB and CIEDE2000 against the published pairs of [Sharma et al. 2005, table 1], which were chosen
 * so that each branch of the formula shows; and CIELAB of sRGB's primaries. */
#include "tests/testing.h"

#include "config/colour/lab.h"

#include <math.h>

static void test_published_pairs(void **state)
{
    (void)state;
    static const struct {
        struct tl_lab p, q;
        double difference;
    } pairs[] = {
        {{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
        {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
        {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
        {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
        {{50, -1.1848, -84.8006}, {50, 0, -82.7485}, 1.0000},
        {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
        {{50, 0, 0}, {50, -1, 2}, 2.3669},
        {{50, -1, 2}, {50, 0, 0}, 2.3669},
        {{50, 2.49, -0.001}, {50, -2.49, 0.0009}, 7.1792},
        {{50, 2.49, -0.001}, {50, -2.49, 0.0011}, 7.2195},
        {{50, -0.001, 2.49}, {50, 0.0009, -2.49}, 4.8045},
        {{50, -0.001, 2.49}, {50, 0.0011, -2.49}, 4.7461},
        {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
        {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
        {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
        {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
        {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
        {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
        {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        assert_near(tl_lab_difference(pairs[i].p, pairs[i].q), pairs[i].difference, 0.5e-4);
        assert_near(tl_lab_difference(pairs[i].q, pairs[i].p), pairs[i].difference, 0.5e-4);
    }
}

/* Lindbloom's values for sRGB and D65, to the digits that his white point shares with Rec. 709's. */
static void test_primaries(void **state)
{
    (void)state;
    static const struct {
        float rgb[3];
        struct tl_lab lab;
    } known[] = {{{1, 1, 1}, {100, 0, 0}},
                 {{0, 0, 0}, {0, 0, 0}},
                 {{1, 0, 0}, {53.24, 80.09, 67.20}},
                 {{0, 1, 0}, {87.74, -86.18, 83.18}},
                 {{0, 0, 1}, {32.30, 79.19, -107.86}},
                 {{0.184187f, 0.184187f, 0.184187f}, {50, 0, 0}}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        struct tl_lab lab = tl_lab_of(known[i].rgb);
        assert_near(lab.l, known[i].lab.l, 0.03);
        assert_near(lab.a, known[i].lab.a, 0.03);
        assert_near(lab.b, known[i].lab.b, 0.03);
    }
}

/* Colours that Rec. 709 shows come back from their CIELAB: its cube's corners, edges and inside, and grey on
 * both pieces of the curve. The tolerance is the last digit of the matrices' constants. */
static void test_there_and_back(void **state)
{
    (void)state;
    static const float steps[] = {0, 0.001f, 0.02f, 0.3f, 0.7f, 1};
    enum { STEPS = sizeof steps / sizeof *steps };
    for (int i = 0; i < STEPS * STEPS * STEPS; i++) {
        const float rgb[3] = {steps[i % STEPS], steps[i / STEPS % STEPS], steps[i / STEPS / STEPS]};
        float back[3];
        assert_near(tl_lab_to_rgb(tl_lab_of(rgb), back), 1, 0);
        for (int c = 0; c < 3; c++)
            assert_near(back[c], rgb[c], 1e-6);
    }
}

/* A colour beyond Rec. 709 keeps lightness and hue, and lies on the border: a channel is 0 or 1. */
static void test_beyond_the_gamut(void **state)
{
    (void)state;
    static const struct tl_lab beyond[] = {
        {60, 90, 50}, {50, -100, 0}, {90, 0, 128}, {20, 60, -120}, {99, -40, -40}};
    for (size_t i = 0; i < sizeof beyond / sizeof *beyond; i++) {
        float rgb[3];
        const double scale = tl_lab_to_rgb(beyond[i], rgb);
        assert_true(scale > 0 && scale < 1);
        const struct tl_lab shown = tl_lab_of(rgb);
        assert_near(shown.l, beyond[i].l, 0.01);
        assert_near(shown.a, scale * beyond[i].a, 0.01);
        assert_near(shown.b, scale * beyond[i].b, 0.01);
        double nearest = 1;
        for (int c = 0; c < 3; c++)
            nearest = fmin(nearest, (double)fminf(rgb[c], 1 - rgb[c]));
        assert_near(nearest, 0, 2e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_published_pairs), cmocka_unit_test(test_primaries),
        cmocka_unit_test(test_there_and_back), cmocka_unit_test(test_beyond_the_gamut)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
