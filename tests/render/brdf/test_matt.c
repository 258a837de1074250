/* The diffuse reflectance of rough cloth and of threads: against the angles of the papers, by brute force
 * over the hemisphere, in double. */
#include "render/brdf/material_lobes.h"

#include "config/base/memory.h"
#include "tests/testing.h"

#include <math.h>

#define ROWS    4000 /* of the hemisphere, of equal squared sines: each has the same part of an even light */
#define COLUMNS 96

static const float roughnesses[] = {0.1f, 0.3f, 0.6f, 1};
static const double angles[] = {0, 0.3, 0.7, 1.1, 1.4, 1.55};

/* [Oren and Nayar 1994, eq. 30] over Lambert's value, as it stands there. */
static double by_angles(double roughness, double light, double viewer, double azimuth)
{
    const double square = roughness * roughness;
    const double even = 1 - 0.5 * square / (square + 0.33), towards = 0.45 * square / (square + 0.09);
    return even + towards * fmax(0, cos(azimuth)) * sin(fmax(light, viewer)) * tan(fmin(light, viewer));
}

static vec3s direction(double angle, double azimuth)
{
    return (vec3s){
        {(float)(sin(angle) * cos(azimuth)), (float)(sin(angle) * sin(azimuth)), (float)cos(angle)}};
}

static vec4s law_of(float roughness)
{
    tl_material material = tl_material_default("rough");
    material.diffuse_roughness = roughness;
    return tl_material_law(&material);
}

static float factor_of(float roughness, vec3s l, vec3s v)
{
    return matt_factor(law_of(roughness), l.z, v.z, glms_vec3_dot(l, v), 0);
}

/* The same from cosines; and reciprocal to the bit. Float keeps six digits of the cosines, which are divided
 * by one of at least 0.02. */
static void test_cosines_stand_for_angles(void **state)
{
    (void)state;
    for (size_t r = 0; r < TL_COUNT(roughnesses); r++)
        for (size_t a = 0; a < TL_COUNT(angles); a++)
            for (size_t b = 0; b < TL_COUNT(angles); b++)
                for (int turn = 0; turn < 8; turn++) {
                    const vec3s l = direction(angles[a], 0.8 * turn), v = direction(angles[b], 0);
                    const float there = factor_of(roughnesses[r], l, v);
                    assert_near(there, by_angles((double)roughnesses[r], angles[a], angles[b], 0.8 * turn),
                                2e-5);
                    assert_near(there, factor_of(roughnesses[r], v, l), 0);
                }
}

/* Lambert's law, to the bit. */
static void test_smooth_is_lambert(void **state)
{
    (void)state;
    const vec3s n = {{0, 0, 1}}, none = {{0, 0, 0}};
    for (size_t a = 0; a < TL_COUNT(angles); a++) {
        const vec3s l = direction(angles[a], 1), v = direction(angles[TL_COUNT(angles) - 1 - a], 0);
        assert_near(factor_of(0, l, v), 1, 0);
        const MaterialLayers layers = material_layers(law_of(0), 0, 1, none, 0.5f, 0, n, n, none, v);
        assert_near(layers.matt_albedo, 1, 0);
        assert_near(material_matt(layers, l), 1, 0);
    }
    assert_near(matt_albedo_mean(law_of(0)), 1, 0);
}

static double albedo_by_force(double roughness, double viewer)
{
    double sum = 0;
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++)
            sum += by_angles(roughness, asin(sqrt((row + 0.5) / ROWS)), viewer,
                             2 * M_PI * (column + 0.5) / COLUMNS);
    return sum / ((double)ROWS * COLUMNS);
}

/* The share of even light that comes back: the form gains light at grazing views, A + B / 2 at the horizon,
 * which is 1.0152 at most. The arc cosine errs by 7e-5, the quadrature by 3e-5 at the
 * horizon. */
static void test_albedo(void **state)
{
    (void)state;
    for (size_t r = 0; r < TL_COUNT(roughnesses); r++)
        for (size_t a = 0; a < TL_COUNT(angles); a++) {
            const double expected = albedo_by_force((double)roughnesses[r], angles[a]);
            const float albedo = matt_albedo(law_of(roughnesses[r]), (float)cos(angles[a]));
            assert_near(albedo, expected, 1e-4);
            assert_true(albedo < 1.016f);
        }
}

static void test_mean_albedo(void **state)
{
    (void)state;
    const int steps = 20000;
    for (size_t r = 0; r < TL_COUNT(roughnesses); r++) {
        double sum = 0;
        for (int i = 0; i < steps; i++)
            sum += (double)matt_albedo(law_of(roughnesses[r]), (float)sqrt((i + 0.5) / steps)) / steps;
        assert_near(matt_albedo_mean(law_of(roughnesses[r])), sum, 5e-5);
        assert_true(sum < 1);
    }
}

static vec4s threads_law(void)
{
    tl_material material = tl_material_default("threads");
    material.gloss.model = TL_REFLECT_BANKS;
    return tl_material_law(&material);
}

/* n'.l of [Heidrich and Seidel 1999, eq. 4] as it stands there, n' being l projected into the plane across t;
 * and its mean over an even hemisphere, for any viewer and as it bounces. */
static void test_threads(void **state)
{
    (void)state;
    const vec3s n = {{0, 0, 1}}, t = {{0.6f, 0.8f, 0}};
    double sum = 0;
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++) {
            const vec3s l = direction(asin(sqrt((row + 0.5) / ROWS)), 2 * M_PI * (column + 0.5) / COLUMNS);
            const vec3s across = glms_vec3_sub(l, glms_vec3_scale(t, glms_vec3_dot(t, l)));
            const float expected = glms_vec3_dot(glms_vec3_normalize(across), l);
            assert_near(matt_under(threads_law(), n, t, l, n), expected, 1e-4);
            sum += (double)expected / ((double)ROWS * COLUMNS);
        }
    assert_near(matt_albedo(threads_law(), 0.3f), sum, 1e-4);
    assert_near(matt_albedo_mean(threads_law()), sum, 1e-4);
    assert_false(tl_material_is_lambert(&(tl_material){.gloss.model = TL_REFLECT_BANKS}));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cosines_stand_for_angles), cmocka_unit_test(test_smooth_is_lambert),
        cmocka_unit_test(test_albedo), cmocka_unit_test(test_mean_albedo), cmocka_unit_test(test_threads)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
