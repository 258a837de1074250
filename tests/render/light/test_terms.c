/* The light's scalar terms (their C face) against numerical integration over discs on the sphere. */
#include "render/light/terms.h"

#include "tests/testing.h"

#define RINGS   60
#define SPOKES  90
#define RADIANS (float)(M_PI / 180)

/* Mean over a disc of half-angle `cone`, whose centre lies at `angle` from the axis, of what `value` makes of
 * the cosine to the axis. Rings of equal area; the disc is symmetric, so half of it will do. */
static double disc_mean(double cone, double angle, double exponent, double (*value)(double, double))
{
    double sum = 0;
    for (int ring = 0; ring < RINGS; ring++) {
        double c = 1 - (ring + 0.5) / RINGS * (1 - cos(cone)), s = sqrt(1 - c * c);
        for (int spoke = 0; spoke < SPOKES; spoke++)
            sum += value(c * cos(angle) + s * sin(angle) * cos((spoke + 0.5) * M_PI / SPOKES), exponent);
    }
    return sum / (RINGS * SPOKES);
}

static double lobe(double cosine, double exponent)
{
    return cosine > 0 ? (exponent + 1) / (2 * M_PI) * pow(cosine, exponent) : 0;
}

/* Root mean square angle from the centre, over the disc. */
static double disc_spread(double cone)
{
    double sum = 0;
    for (int i = 0; i < 1000; i++)
        sum += pow(acos(1 - (i + 0.5) / 1000 * (1 - cos(cone))), 2);
    return sqrt(sum / 1000);
}

/* L1 distance from the true average over the disc, relative to its integral. */
static double broadening_error(double exponent, double cone)
{
    float broadened = lobe_broadened_exponent((float)exponent, (float)disc_spread(cone));
    double error = 0, whole = 0;
    for (int i = 0; i < 360; i++) {
        double angle = (i + 0.5) * M_PI / 360, truth = disc_mean(cone, angle, exponent, lobe);
        error += fabs((double)lobe_cosine(broadened, (float)cos(angle)) - truth) * sin(angle);
        whole += truth * sin(angle);
    }
    return error / whole;
}

/* A lobe over a whole sphere integrates to 1, and is what its formula says. */
static void test_lobe(void **state)
{
    (void)state;
    for (float s = 1; s < 2000; s *= 3) { // NOLINT: a few steps
        double sum = 0;
        for (int i = 0; i < 20000; i++) { /* midpoints of the cosine over the hemisphere */
            float cosine = ((float)i + 0.5f) / 20000;
            sum += (double)lobe_cosine(s, cosine) * 2 * M_PI / 20000;
        }
        assert_near(sum, 1, 1e-4);
        assert_near(lobe_cosine(s, -0.5f), 0, 1e-25);
    }
}

/* The bounds that terms.glsl states. Without broadening the same cases are off by up to 30 %. */
static void test_broadened_lobe(void **state)
{
    (void)state;
    const double cones[] = {0.05, 0.1, 0.2, 0.3, 0.41}, exponents[] = {1, 2, 4, 8, 20, 64, 200, 1000};
    int close = 0;
    for (size_t c = 0; c < sizeof cones / sizeof *cones; c++)
        for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
            double width = pow(disc_spread(cones[c]), 2) * (exponents[e] + 1);
            if (width > 2)
                continue;
            /* A lobe that its own hemisphere cuts gets a foot that no power has: 8 % at s = 1 in the largest
             * region. */
            double foot = 0.45 * cones[c] * cones[c] / sqrt(exponents[e]);
            assert_near(broadening_error(exponents[e], cones[c]), 0, foot + (width < 1 ? 0.03 : 0.10));
            close += width < 1;
        }
    assert_true(close > 20);
}

static void test_broadening_is_continuous_and_bounded(void **state)
{
    (void)state;
    assert_near(lobe_broadened_exponent(20, 0), 20, 2e-5);
    assert_near(lobe_broadened_exponent(1e6f, 0.1f), 2 / 0.01 - 1, 0.1); /* the region's own width */
    assert_near(lobe_broadened_exponent(1, 3), 0.25, 0);
    for (float spread = 0; spread < 3; spread += 0.05f) // NOLINT: a few steps
        assert_true(lobe_broadened_exponent(50, spread + 0.05f) <= lobe_broadened_exponent(50, spread));
}

static double clamped(double cosine, double unused)
{
    (void)unused;
    return fmax(cosine, 0);
}

/* The bound that terms.glsl states. (A parabola, as of a bar instead of a disc, is off by 0.038 at u = 0.) */
static void test_disc_height(void **state)
{
    (void)state;
    for (int i = -150; i <= 150; i++) {
        double u = i / 100.0, v = fmin(fmax(u, -1), 1);
        double part = (v * (M_PI / 2 + asin(v)) + (2 + v * v) * sqrt(1 - v * v) / 3) / M_PI;
        assert_near(disc_height((float)u), part + fmax(u - 1, 0), 0.0015);
        assert_true(disc_height((float)u) >= 0);
    }
}

/* The true mean over a disc of half-angle `cone` also sinks with the disc's own mean cosine: 0.02 at most. */
static void test_disc_cosine(void **state)
{
    (void)state;
    const double cones[] = {0.05, 0.1, 0.2};
    for (int c = 0; c < 3; c++)
        for (int degrees = 0; degrees <= 180; degrees++) {
            double angle = (double)((float)degrees * RADIANS);
            assert_near(disc_cosine((float)cos(angle), (float)sin(cones[c])),
                        disc_mean(cones[c], angle, 0, clamped),
                        0.0015 * cones[c] + 0.3 * cones[c] * cones[c]);
        }
}

static void test_disc_share(void **state)
{
    (void)state;
    for (int i = -150; i <= 150; i++) {
        double u = i / 100.0, v = fmin(fmax(u, -1), 1);
        assert_near(disc_share((float)u), 0.5 + (v * sqrt(1 - v * v) + asin(v)) / M_PI, 0.0013);
    }
    assert_near(disc_share(1), 1, 1e-6);
    assert_near(disc_share(-1), 0, 1e-6);
}

static void test_self_shadow_ramp(void **state)
{
    (void)state;
    assert_near(self_shadow_ramp(-0.1f), 0, 0);
    assert_near(self_shadow_ramp(0.015625f), 0.5, 0);
    assert_near(self_shadow_ramp(0.5f), 1, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lobe),
        cmocka_unit_test(test_broadened_lobe),
        cmocka_unit_test(test_broadening_is_continuous_and_bounded),
        cmocka_unit_test(test_disc_height),
        cmocka_unit_test(test_disc_cosine),
        cmocka_unit_test(test_disc_share),
        cmocka_unit_test(test_self_shadow_ramp),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
