/* CIELAB and CIEDE2000 against the published pairs of Sharma, Wu and Dalal 2005, table 1, which were chosen
 * so that each branch of the formula shows; and CIELAB of sRGB's primaries. */
#include "tests/testing.h"

#include "render/metrics/lab.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_published_pairs),
                                       cmocka_unit_test(test_primaries)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
