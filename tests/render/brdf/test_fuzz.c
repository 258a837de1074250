/* The sheen of fibres and the cosine powers that stand for it, by brute force over the hemisphere. */
#include "render/brdf/material_lobes.h"

#include "tests/testing.h"

#include "render/env/exponent.h"
#include "render/env/lobes.h"

#include <math.h>

#define ROWS    400 /* of the hemisphere, of equal height */
#define COLUMNS 360

static const float cosines[] = {0.05f, 0.17f, 0.33f, 0.5f, 0.83f, 1};
#define VIEWS (sizeof cosines / sizeof cosines[0])

static vec3s direction(float z, float azimuth)
{
    float radius = sqrtf(1 - z * z);
    return (vec3s){{radius * cosf(azimuth), radius * sinf(azimuth), z}};
}

static vec3s at(int row, int column)
{
    return direction(((float)row + 0.5f) / ROWS, 2 * GLM_PIf * ((float)column + 0.5f) / COLUMNS);
}

/* The lobe is a transformed distribution: it sends back the albedo, whatever the transformation. The azimuth
 * of the viewer counts for nothing else than where the lobe points. */
static void test_the_lobe_has_its_albedo(void **state)
{
    (void)state;
    const vec3s up = {{0, 0, 1}};
    for (int r = 2; r <= 5; r++)
        for (size_t i = 0; i < VIEWS; i++) {
            const float y = 0.2f * (float)r;
            const struct tl_fuzz fuzz = {{{1, 1, 1}}, y, 0};
            double sum = 0;
            for (int row = 0; row < ROWS; row++)
                for (int column = 0; column < COLUMNS; column++)
                    sum +=
                        (double)fuzz_value(fuzz.roughness, up, at(row, column), direction(cosines[i], 0.7f));
            sum *= 2 * M_PI / (ROWS * COLUMNS);
            /* rows are a step of 1/400 of a lobe that begins within some of them */
            assert_near(sum, fuzz_albedo(cosines[i], y), 0.01 * (double)fuzz_albedo(cosines[i], y));
            assert_true(sum < 1);
        }
}

/* Half of the light that the powers send elsewhere than the lobe does, as a share of it. Bounds are measured,
 * rounded up: the azimuth costs 2 to 7 %, the rest is what four powers cannot follow near the horizon. */
static void test_powers_stand_for_the_lobe(void **state)
{
    (void)state;
    static const double bounds[3][VIEWS] = {{0.36, 0.19, 0.09, 0.05, 0.02, 0.01},
                                            {0.20, 0.09, 0.05, 0.035, 0.015, 0.008},
                                            {0.09, 0.07, 0.06, 0.045, 0.025, 0.008}};
    const float roughnesses[3] = {0.4f, 0.5f, 0.7f};
    const vec3s up = {{0, 0, 1}};
    for (int r = 0; r < 3; r++)
        for (size_t i = 0; i < VIEWS; i++) {
            const struct tl_fuzz fuzz = {{{1, 1, 1}}, roughnesses[r], 0};
            float lobes[FUZZ_POWERS];
            fuzz_lobes(fuzz.roughness, cosines[i], lobes);
            const double albedo = (double)fuzz_albedo(cosines[i], fuzz.roughness);
            double off = 0, sum = 0;
            for (int k = 0; k < FUZZ_POWERS; k++)
                sum += (double)lobes[k];
            assert_near(sum, albedo, 1e-5); /* the furnace */
            assert_near(fuzz_under(fuzz.colour, fuzz.roughness, cosines[i]), 1 - albedo, 1e-6);
            for (int row = 0; row < ROWS; row++)
                for (int column = 0; column < COLUMNS; column++) {
                    vec3s l = at(row, column);
                    float powers = 0;
                    for (int k = 0; k < FUZZ_POWERS; k++)
                        powers += lobes[k] * tl_lobe_cosine(tl_exponent(TL_FUZZ_INDEX(k)), l.z);
                    off += fabs(
                        (double)(powers - fuzz_value(fuzz.roughness, up, l, direction(cosines[i], 0.7f))));
                    assert_near(fuzz_lobes_at(lobes, l.z), fmaxf(powers, 0), 1e-4);
                }
            off *= M_PI / (ROWS * COLUMNS) / albedo;
            print_message("roughness %.1f, cosine %.2f: albedo %.3f, %.1f %% sent elsewhere\n",
                          (double)fuzz.roughness, (double)cosines[i], albedo, 100 * off);
            assert_true(off < bounds[r][i]);
        }
}

/* A white cloth with white fibres neither gains nor loses light that comes from everywhere. */
static void test_what_is_left_below(void **state)
{
    (void)state;
    const vec3s n = {{0, 0, 1}}, none = {{0, 0, 0}}, colour = {{0.5f, 0.25f, 0.1f}};
    const vec4s lambert = {{0, 0, 0, 0}};
    for (size_t i = 0; i < VIEWS; i++) {
        const vec3s v = {{sqrtf(1 - cosines[i] * cosines[i]), 0, cosines[i]}};
        assert_near(material_layers(lambert, 0, 1, none, 0.6f, 0, n, n, none, v).base, 1, 0);
        assert_near(material_layers(lambert, 0, 1, colour, 0.6f, 0, n, n, none, v).base,
                    1 - 0.5f * fuzz_albedo(cosines[i], 0.6f), 1e-6);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_the_lobe_has_its_albedo),
                                       cmocka_unit_test(test_powers_stand_for_the_lobe),
                                       cmocka_unit_test(test_what_is_left_below)};
    return cmocka_run_group_tests_name("fuzz", tests, NULL, NULL);
}
