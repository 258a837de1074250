#include "render/metrics/flip.h"

#include "tests/testing.h"

#include <string.h>

#define WIDTH  48
#define HEIGHT 32
#define PIXELS (WIDTH * HEIGHT)

static const struct tl_flip_frame frame = {WIDTH, HEIGHT, TL_FLIP_PIXELS_PER_DEGREE};

static float noise(int seed)
{
    uint32_t hash = (uint32_t)seed * 2654435761u;
    hash ^= hash >> 15;
    hash *= 2246822519u;
    return (float)(hash >> 8) / (float)(1 << 24);
}

static void fill(float *rgb, float red, float green, float blue)
{
    for (float *end = rgb + 3 * (size_t)PIXELS; rgb < end; rgb += 3) {
        rgb[0] = red;
        rgb[1] = green;
        rgb[2] = blue;
    }
}

static double mean_ldr(const float *test, const float *reference)
{
    static float map[PIXELS];
    double sum = 0;
    tl_flip_ldr(&frame, test, reference, map);
    for (int i = 0; i < PIXELS; i++) {
        assert_true(map[i] >= 0 && map[i] <= 1);
        sum += (double)map[i] / PIXELS;
    }
    return sum;
}

/* -- The papers' formulas in double, pixel by pixel, with whole two-dimensional kernels -------------------
 */

static const double white[3] = {0.950428545, 1, 1.088900371};

static void to_xyz(const double rgb[3], double xyz[3]) /* relative to white */
{
    const double m[3][3] = {{10135552 / 24577794.0, 8788810 / 24577794.0, 4435075 / 24577794.0},
                            {2613072 / 12288897.0, 8788810 / 12288897.0, 887015 / 12288897.0},
                            {1425312 / 73733382.0, 8788810 / 73733382.0, 70074185 / 73733382.0}};
    for (int i = 0; i < 3; i++)
        xyz[i] = (m[i][0] * rgb[0] + m[i][1] * rgb[1] + m[i][2] * rgb[2]) / white[i];
}

static void to_rgb(const double relative[3], double rgb[3])
{
    const double m[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                            {-0.969224334, 1.875930071, 0.041554224},
                            {0.055639423, -0.204011202, 1.057148933}};
    for (int i = 0; i < 3; i++) {
        double value = 0;
        for (int k = 0; k < 3; k++)
            value += m[i][k] * relative[k] * white[k];
        rgb[i] = fmin(fmax(value, 0), 1);
    }
}

static void to_hunt(const double rgb[3], double hunt[3])
{
    double f[3];
    to_xyz(rgb, f);
    for (int i = 0; i < 3; i++)
        f[i] = f[i] > pow(6.0 / 29, 3) ? cbrt(f[i]) : f[i] / (3 * pow(6.0 / 29, 2)) + 4.0 / 29;
    hunt[0] = 116 * f[1] - 16;
    hunt[1] = 0.01 * hunt[0] * 500 * (f[0] - f[1]);
    hunt[2] = 0.01 * hunt[0] * 200 * (f[1] - f[2]);
}

static double hyab(const double p[3], const double q[3])
{
    return fabs(p[0] - q[0]) + hypot(p[1] - q[1], p[2] - q[2]);
}

static double opponent(const float *rgb, int x, int y, int channel)
{
    x = x < 0 ? 0 : x >= WIDTH ? WIDTH - 1 : x;
    y = y < 0 ? 0 : y >= HEIGHT ? HEIGHT - 1 : y;
    const float *texel = rgb + 3 * (size_t)(y * WIDTH + x);
    double xyz[3];
    to_xyz((double[]){(double)texel[0], (double)texel[1], (double)texel[2]}, xyz);
    return channel == 0   ? 116 * xyz[1] - 16
           : channel == 1 ? 500 * (xyz[0] - xyz[1])
                          : 200 * (xyz[1] - xyz[2]);
}

static void direct_colour(const float *rgb, int x, int y, double hunt[3])
{
    const double a[3][2] = {{1, 0}, {1, 0}, {34.1, 13.5}};
    const double b[3][2] = {{0.0047, 1e-5}, {0.0053, 1e-5}, {0.04, 0.025}};
    double filtered[3];
    for (int channel = 0; channel < 3; channel++) {
        double sum = 0, weights = 0;
        for (int j = -10; j <= 10; j++) {
            for (int i = -10; i <= 10; i++) {
                double z = (i * i + j * j) / (frame.pixels_per_degree * frame.pixels_per_degree), weight = 0;
                for (int k = 0; k < 2; k++)
                    weight +=
                        a[channel][k] * sqrt(M_PI / b[channel][k]) * exp(-M_PI * M_PI * z / b[channel][k]);
                sum += weight * opponent(rgb, x + i, y + j, channel);
                weights += weight;
            }
        }
        filtered[channel] = sum / weights;
    }
    double luminance = (filtered[0] + 16) / 116, clamped[3];
    to_rgb((double[]){luminance + filtered[1] / 500, luminance, luminance - filtered[2] / 200}, clamped);
    to_hunt(clamped, hunt);
}

/* Length of the response to the first or second derivative of a Gaussian along x and y. */
static double direct_feature(const float *rgb, int x, int y, int order)
{
    double sigma = 0.5 * 0.082 * frame.pixels_per_degree, response[2] = {0};
    for (int axis = 0; axis < 2; axis++) {
        double positive = 0, negative = 0, positive_weights = 0, negative_weights = 0;
        for (int j = -9; j <= 9; j++) {
            for (int i = -9; i <= 9; i++) {
                int along = axis == 0 ? i : j;
                double weight = exp(-(i * i + j * j) / (2 * sigma * sigma)) *
                                (order == 1 ? -along : along * along / (sigma * sigma) - 1);
                double value = (opponent(rgb, x + i, y + j, 0) + 16) / 116;
                *(weight > 0 ? &positive : &negative) += weight * value;
                *(weight > 0 ? &positive_weights : &negative_weights) += fabs(weight);
            }
        }
        response[axis] = positive / positive_weights + negative / negative_weights;
    }
    return hypot(response[0], response[1]);
}

static double direct_flip(const float *test, const float *reference, int x, int y)
{
    double p[3], q[3], green[3], blue[3];
    direct_colour(test, x, y, p);
    direct_colour(reference, x, y, q);
    to_hunt((double[]){0, 1, 0}, green);
    to_hunt((double[]){0, 0, 1}, blue);
    double largest = pow(hyab(green, blue), 0.7), difference = pow(hyab(p, q), 0.7), knee = 0.4 * largest;
    double colour =
        difference < knee ? 0.95 / knee * difference : 0.95 + (difference - knee) / (largest - knee) * 0.05;
    double edge = fabs(direct_feature(test, x, y, 1) - direct_feature(reference, x, y, 1));
    double point = fabs(direct_feature(test, x, y, 2) - direct_feature(reference, x, y, 2));
    return pow(colour, 1 - pow(fmax(edge, point) / sqrt(2), 0.5));
}

/* Blocks of colour against the same, smeared by noise: edges, points and frame borders all play. In float the
 * separated filters differ in the fifth digit of opponents of up to 100, and the exponents pull small
 * differences up. */
static void maps_match_the_formulas(void **state)
{
    (void)state;
    static float reference[3 * PIXELS], test[3 * PIXELS], map[PIXELS];
    for (int i = 0; i < 3 * PIXELS; i++) {
        int block = i / 3 % WIDTH / 7 + 8 * (i / 3 / WIDTH / 5);
        reference[i] = noise(3 * block + i % 3);
        test[i] = fminf(1, 0.6f * reference[i] + 0.4f * noise(i + 1000));
    }
    tl_flip_ldr(&frame, test, reference, map);
    for (int y = 0; y < HEIGHT; y += 3)
        for (int x = 0; x < WIDTH; x += 5)
            assert_near(map[y * WIDTH + x], direct_flip(test, reference, x, y), 2e-4);
}

/* Constant images leave filters and features nothing to do: black against white is a HyAB distance of 100,
 * and the map a closed form of it. */
static void black_against_white(void **state)
{
    (void)state;
    static float black[3 * PIXELS], full[3 * PIXELS];
    fill(full, 1, 1, 1);
    double green[3], blue[3];
    to_hunt((double[]){0, 1, 0}, green);
    to_hunt((double[]){0, 0, 1}, blue);
    double largest = pow(hyab(green, blue), 0.7), knee = 0.4 * largest;
    double expected = 0.95 + (pow(100, 0.7) - knee) / (largest - knee) * 0.05;
    assert_near(mean_ldr(full, black), expected, 1e-4);
    assert_near(expected, 0.967, 1e-3);
    /* green against blue is what the scale ends at */
    static float pure_green[3 * PIXELS], pure_blue[3 * PIXELS];
    fill(pure_green, 0, 1, 0);
    fill(pure_blue, 0, 0, 1);
    assert_near(mean_ldr(pure_green, pure_blue), 1, 1e-4);
}

static void equal_images_do_not_differ(void **state)
{
    (void)state;
    static float image[3 * PIXELS], map[PIXELS];
    for (int i = 0; i < 3 * PIXELS; i++)
        image[i] = 4 * noise(i);
    assert_near(mean_ldr(image, image), 0, 0);
    tl_flip_hdr(&frame, image, image, -3, 2, map);
    for (int i = 0; i < PIXELS; i++)
        assert_near(map[i], 0, 0);
}

static void ldr_is_symmetric(void **state)
{
    (void)state;
    static float p[3 * PIXELS], q[3 * PIXELS];
    for (int i = 0; i < 3 * PIXELS; i++) {
        p[i] = noise(i);
        q[i] = noise(i + 77777);
    }
    assert_near(mean_ldr(p, q), mean_ldr(q, p), 1e-6);
}

static void more_noise_differs_more(void **state)
{
    (void)state;
    static float reference[3 * PIXELS], test[3 * PIXELS];
    fill(reference, 0.4f, 0.5f, 0.3f);
    double previous = 0;
    for (int power = 0; power < 5; power++) {
        float strength = ldexpf(0.02f, power);
        for (int i = 0; i < 3 * PIXELS; i++)
            test[i] = reference[i] + strength * (noise(i) - 0.5f);
        double mean = mean_ldr(test, reference);
        assert_true(mean > previous);
        previous = mean;
    }
    assert_true(previous > 0.1);
}

/* The same picture moved by one pixel differs far less than its negative. */
static void a_small_shift_is_small(void **state)
{
    (void)state;
    static float reference[3 * PIXELS], shifted[3 * PIXELS], negative[3 * PIXELS];
    for (int i = 0; i < 3 * PIXELS; i++) {
        int x = i / 3 % WIDTH, y = i / 3 / WIDTH;
        reference[i] = 0.5f + 0.4f * sinf(0.2f * (float)x) * cosf(0.3f * (float)y);
        shifted[i] = 0.5f + 0.4f * sinf(0.2f * (float)(x + 1)) * cosf(0.3f * (float)y);
        negative[i] = 1 - reference[i];
    }
    assert_true(mean_ldr(shifted, reference) < 0.2);
    assert_true(mean_ldr(shifted, reference) < 0.4 * mean_ldr(negative, reference));
}

static double tone_mapped(double x) /* the curve of [Narkowicz 2016] without its pre-exposure */
{
    x *= 0.6;
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

static void exposures_show_peak_and_median(void **state)
{
    (void)state;
    float luminances[] = {4, 0.25f, 1, 1000, 0.125f};
    double start, stop;
    assert_true(tl_flip_exposures(luminances, 5, &start, &stop));
    assert_near(tone_mapped(exp2(start) * 1000), 0.85, 1e-6);
    assert_near(tone_mapped(exp2(stop) * 1), 0.85, 1e-6);
    assert_near(stop - start, log2(1000), 1e-9);

    float even[] = {2, 4, 1, 8}; /* the median lies between the middle two */
    assert_true(tl_flip_exposures(even, 4, &start, &stop));
    assert_near(stop - start, log2(8 / 3.0), 1e-9);

    float dark[] = {0, 0, 0, 5};
    assert_false(tl_flip_exposures(dark, 4, &start, &stop));
    float none[] = {0};
    assert_false(tl_flip_exposures(none, 1, &start, &stop));
    assert_false(tl_flip_exposures(none, 0, &start, &stop));
}

/* HDR-FLIP is the largest LDR-FLIP of the images as shown at each exposure. */
static void hdr_is_the_worst_exposure(void **state)
{
    (void)state;
    static float reference[3 * PIXELS], test[3 * PIXELS], map[PIXELS], shown[2][3 * PIXELS], single[PIXELS],
        expected[PIXELS];
    for (int i = 0; i < 3 * PIXELS; i++) {
        reference[i] = exp2f(8 * noise(i / 24) - 4);
        test[i] = reference[i] * (1 + 0.5f * noise(i + 9999));
    }
    tl_flip_hdr(&frame, test, reference, -3, 1.5, map); /* five exposures */
    memset(expected, 0, sizeof expected);
    for (int k = 0; k < 5; k++) {
        double scale = exp2(-3 + 4.5 * k / 4);
        for (int i = 0; i < 3 * PIXELS; i++) {
            shown[0][i] = (float)tone_mapped(scale * (double)test[i]);
            shown[1][i] = (float)tone_mapped(scale * (double)reference[i]);
        }
        tl_flip_ldr(&frame, shown[0], shown[1], single);
        for (int i = 0; i < PIXELS; i++)
            expected[i] = fmaxf(expected[i], single[i]);
    }
    for (int i = 0; i < PIXELS; i++)
        assert_near(map[i], expected[i], 1e-4);
}

/* The extremes of float stay within [0, 1]. */
static void extremes_stay_finite(void **state)
{
    (void)state;
    static float reference[3 * PIXELS], test[3 * PIXELS], map[PIXELS];
    for (int i = 0; i < 3 * PIXELS; i++) {
        reference[i] = i % 5 ? 1e-38f : 3e38f;
        test[i] = i % 7 ? -3e38f : 65504;
    }
    tl_flip_hdr(&frame, test, reference, -130, 130, map);
    for (int i = 0; i < PIXELS; i++)
        assert_true(map[i] >= 0 && map[i] <= 1);
    assert_true(mean_ldr(test, reference) > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_match_the_formulas),        cmocka_unit_test(black_against_white),
        cmocka_unit_test(equal_images_do_not_differ),     cmocka_unit_test(ldr_is_symmetric),
        cmocka_unit_test(more_noise_differs_more),        cmocka_unit_test(a_small_shift_is_small),
        cmocka_unit_test(exposures_show_peak_and_median), cmocka_unit_test(hdr_is_the_worst_exposure),
        cmocka_unit_test(extremes_stay_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
