/* Directions sampled from an environment, in both layouts, with a yaw. */
#include "config/base/memory.h"
#include "render/reference/sky.h"

#include "tests/testing.h"

#define SAMPLES 20000

/* Sizes that are no powers of two; a bright texel on a dim slope. */
static tl_environment environment_of(enum tl_env_layout layout)
{
    int width = layout == TL_ENV_CUBE ? 11 : 37, height = layout == TL_ENV_CUBE ? 66 : 19;
    tl_environment environment = {.layout = layout, .image = tl_image_create(width, height, 3, TL_IMAGE_F32)};
    for (int i = 0; i < width * height * 3; i++)
        tl_image_floats(&environment.image)[i] = i / 3 == 200 ? 500.0f : (float)i / 1000;
    return environment;
}

static const enum tl_env_layout layouts[] = {TL_ENV_LATLONG, TL_ENV_CUBE};

/* The curve visits every texel once, and the shares of the draws end at 1. */
static void test_curve(void **state)
{
    (void)state;
    for (size_t l = 0; l < TL_COUNT(layouts); l++) {
        tl_environment environment = environment_of(layouts[l]);
        struct tl_sky sky;
        tl_sky_make(&environment, 0, &sky);
        int *visits = TL_NEW_ARRAY(int, sky.texel_count);
        for (size_t i = 0; i < sky.texel_count; i++)
            visits[sky.order[i]]++;
        for (size_t i = 0; i < sky.texel_count; i++)
            assert_int_equal(visits[i], 1);
        assert_near(sky.before[sky.texel_count], 1, 0);
        free(visits);
        tl_sky_release(&sky);
        tl_environment_release(&environment);
    }
}

/* Samples agree with look-ups: unit direction, radiance and pdf, except where rounding moves a direction
 * across the border of its texel. */
static void test_samples_and_lookups_agree(void **state)
{
    (void)state;
    for (size_t l = 0; l < TL_COUNT(layouts); l++) {
        tl_environment environment = environment_of(layouts[l]);
        struct tl_sky sky;
        int differ = 0;
        tl_sky_make(&environment, 1.3f, &sky);
        for (int i = 0; i < SAMPLES; i++) {
            struct tl_sky_sample sampled = tl_sky_sample_at(&sky, (i + 0.37) / SAMPLES);
            struct tl_sky_sample seen = tl_sky_lookup(&sky, sampled.direction);
            assert_near(glms_vec3_norm(sampled.direction), 1, 1e-6);
            differ +=
                sampled.radiance.x != seen.radiance.x || fabsf(sampled.pdf - seen.pdf) > 1e-5f * sampled.pdf;
        }
        assert_true(differ <= SAMPLES / 1000);
        tl_sky_release(&sky);
        tl_environment_release(&environment);
    }
}

/* Weighed by their densities, draws measure: the sphere is 4 pi sr, its mean direction 0, its second moments
 * 4 pi / 3 each; and light, summed over draws, is what the texels hold. Draws are evenly spaced along the
 * curve, which makes errors of the order of one draw's share for each texel's border: a thousandth. */
static void test_measure(void **state)
{
    (void)state;
    for (size_t l = 0; l < TL_COUNT(layouts); l++) {
        tl_environment environment = environment_of(layouts[l]);
        struct tl_sky sky;
        tl_sky_make(&environment, -2.1f, &sky);
        double area = 0, light = 0, first[3] = {0, 0, 0}, second[3] = {0, 0, 0};
        for (int i = 0; i < SAMPLES; i++) {
            struct tl_sky_sample sampled = tl_sky_sample_at(&sky, (i + 0.5) / SAMPLES);
            double weight = 1 / ((double)sampled.pdf * SAMPLES);
            area += weight;
            light += weight * (double)(sampled.radiance.x + sampled.radiance.y + sampled.radiance.z) / 3;
            for (int c = 0; c < 3; c++) {
                first[c] += weight * (double)sampled.direction.raw[c];
                second[c] += weight * pow((double)sampled.direction.raw[c], 2);
            }
        }
        assert_near(area / (4 * M_PI), 1, 1e-3);
        assert_near(light / sky.brightness, 1, 1e-3);
        for (int c = 0; c < 3; c++) {
            assert_near(first[c] / (4 * M_PI), 0, 1e-3);
            assert_near(second[c] * 3 / (4 * M_PI), 1, 3e-3);
        }
        tl_sky_release(&sky);
        tl_environment_release(&environment);
    }
}

/* Shares of a row are shares of its solid angle: they divide the cosines evenly. The digits of the sine stay,
 * at a pole of a tall picture, too. */
static void test_rows_of_lat_long(void **state)
{
    (void)state;
    const int heights[] = {1, 2, 19, 4096};
    for (size_t h = 0; h < TL_COUNT(heights); h++)
        for (int k = 0; k < 12; k++) {
            const int row = (heights[h] - 1) * (k % 3) / 2;
            const double upper = cos(M_PI * row / heights[h]), lower = cos(M_PI * (row + 1) / heights[h]);
            const double share = 0.1 + 0.2 * k / 3, y = upper + (lower - upper) * share, x = sqrt(1 - y * y);
            const vec3s d = latlong_direction(0.75f, row, heights[h], (float)share);
            assert_near(d.y, y, 2e-7);
            assert_near((double)d.x / x, 1, 1e-6);
            assert_near(d.z, 0, 1e-6);
        }
}

static void test_every_second_bit(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 1000; i++) {
        const uint32_t bits = i * 2654435761u;
        double sum = 0.5;
        for (int k = 0; k < 16; k++)
            sum += (double)(bits >> 2 * k & 1) * (1 << k);
        assert_near(every_second_bit(bits), sum / 65536, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_curve),
        cmocka_unit_test(test_samples_and_lookups_agree),
        cmocka_unit_test(test_measure),
        cmocka_unit_test(test_rows_of_lat_long),
        cmocka_unit_test(test_every_second_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
