#include "render/brdf/tables/tables.h"

#include "config/base/memory.h"
#include "render/brdf/tables/table_error.h"

#include "tests/testing.h"

enum { MODELS = TL_REFLECT_BANKS + 1 };
static const char *const names[MODELS] = {"phong", "blinn_phong", "cosine_lobe", "torrance_sparrow",
                                          "ward",  "banks"};

static struct tl_brdf brdf_of(int model, float glossiness, int fresnel)
{
    tl_material material = tl_material_default("test");
    material.glossiness = glossiness;
    material.gloss.model = model;
    material.gloss.fresnel = fresnel;
    vec3s f0 = fresnel == TL_FRESNEL_SCHLICK ? (vec3s){{0.04f, 0.05f, 0.2f}} : (vec3s){{1, 1, 1}};
    struct tl_brdf brdf = tl_brdf_of(&material, f0, glossiness);
    if (model == TL_REFLECT_WARD)
        brdf.gloss.width_warp *= 0.4f;
    return brdf;
}

static double away_of(const struct tl_brdf *brdf, int size, int precision)
{
    struct tl_brdf_table_params params = {.size = size, .precision = precision, .range = TL_RANGE_SCALED};
    return tl_brdf_table_error(brdf, &params).steep;
}

/* 512 texels in float: half a per cent, for each model. A bilinear table errs by the square of its step, so a
 * quarter of the texels makes it some sixteen times worse: five where other errors mix in. */
static void float_tables_are_the_formula(void **state)
{
    (void)state;
    const float glossiness[] = {0, 0.5f, 0.9f, 0.98f};
    printf("relative RMSE in %%, away from grazing (n.l, n.v >= %.1f)\n%-18s %5s %8s %8s %8s %8s %8s\n",
           (double)TL_GRAZING_COSINE, "", "g", "32 f", "128 f", "512 f", "512 u16", "512 u8");
    for (int model = 0; model < MODELS; model++) {
        for (size_t i = 0; i < TL_COUNT(glossiness); i++) {
            struct tl_brdf brdf = brdf_of(model, glossiness[i], (int)(i % 2));
            double small = away_of(&brdf, 32, TL_PRECISION_FLOAT);
            double middle = away_of(&brdf, 128, TL_PRECISION_FLOAT);
            double large = away_of(&brdf, 512, TL_PRECISION_FLOAT);
            double fixed16 = away_of(&brdf, 512, TL_PRECISION_FIXED16);
            double fixed8 = away_of(&brdf, 512, TL_PRECISION_FIXED8);
            printf("%-18s %5.2f %8.4f %8.4f %8.4f %8.4f %8.4f\n", names[model], (double)glossiness[i],
                   100 * small, 100 * middle, 100 * large, 100 * fixed16, 100 * fixed8);
            assert_true(large <= 0.005);
            assert_true(middle < small / 5 && large < middle / 2);
            assert_true(fixed16 <= 0.005);
            assert_true(fixed8 < 0.1 && fixed8 > 2 * fixed16);
        }
    }
}

/* g -> 1: exact up to the exponent that tables.h states, and finite up to the end. */
static void near_mirrors_are_exact_up_to_the_stated_exponent(void **state)
{
    (void)state;
    for (int model = 0; model < MODELS; model++) {
        struct tl_brdf brdf =
            brdf_of(model, model == TL_REFLECT_BANKS ? 0.998f : 0.9999f, TL_FRESNEL_SCHLICK);
        assert_true(away_of(&brdf, 512, TL_PRECISION_FLOAT) <= 0.005);
        struct tl_brdf mirror = brdf_of(model, 1, TL_FRESNEL_SCHLICK);
        double error = away_of(&mirror, 512, TL_PRECISION_FLOAT);
        printf("%s, s = %.0f: %.2f %%\n", names[model], (double)mirror.exponent, 100 * error);
        assert_true(isfinite(error) && error < 0.5);
    }
}

/* Every variant of the factored model, its two facets, three maskings and three Fresnel terms. */
static void every_torrance_sparrow_holds(void **state)
{
    (void)state;
    for (int variant = 0; variant < 18; variant++) {
        struct tl_brdf brdf = brdf_of(TL_REFLECT_TORRANCE_SPARROW, 0.9f, variant / 6);
        brdf.gloss.facets = variant & 1;
        brdf.gloss.masking = variant / 2 % 3;
        brdf.gloss.extinction = 3;
        assert_true(away_of(&brdf, 512, TL_PRECISION_FLOAT) <= 0.005);
    }
}

/* Along the thread a table over cosines is coarse: angles keep the narrow lobes. */
static void banks_by_angles_is_finer(void **state)
{
    (void)state;
    struct tl_brdf brdf = brdf_of(TL_REFLECT_BANKS, 0.98f, TL_FRESNEL_SCHLICK);
    struct tl_brdf_table_params params = {.size = 512, .precision = TL_PRECISION_FLOAT};
    struct tl_table_error cosines = tl_brdf_table_error(&brdf, &params);
    params.angles = true;
    struct tl_table_error angles = tl_brdf_table_error(&brdf, &params);
    printf("banks, g 0.98, over cosines: %.3f %% away, %.3f %% grazing; over angles: %.3f %%, %.3f %%\n",
           100 * cosines.steep, 100 * cosines.grazing, 100 * angles.steep, 100 * angles.grazing);
    assert_true(cosines.steep <= 0.005 && angles.steep <= 0.005 && angles.grazing < cosines.grazing);
}

/* A2. The factor G / (pi cos b) reaches 1.13/w: cut at 1 it darkens grazing views, the more the shinier the
 * surface; divided by its greatest value it keeps them, within half a step of the texels, and the
 * interpolation.
 */
static void scaling_keeps_what_clamping_darkens(void **state)
{
    (void)state;
    const float glossiness[] = {0.5f, 0.9f, 0.98f}, views[] = {0.7f, 0.3f, 0.1f, 0.03f, 0.01f};
    printf("torrance_sparrow, 8 bits: light shown over light due, by n.v\n%5s %8s %8s %9s %8s\n", "g", "n.v",
           "clamped", "constant", "bound");
    double before = 1;
    for (size_t i = 0; i < TL_COUNT(glossiness); i++) {
        struct tl_brdf brdf = brdf_of(TL_REFLECT_TORRANCE_SPARROW, glossiness[i], TL_FRESNEL_SCHLICK);
        struct tl_brdf_table_params params = {.size = 512, .range = TL_RANGE_CLAMPED};
        struct tl_brdf_tables clamped = tl_brdf_tables_make(&brdf, &params);
        params.range = TL_RANGE_SCALED;
        struct tl_brdf_tables scaled = tl_brdf_tables_make(&brdf, &params);
        assert_near(scaled.tables[1].scale, 2 / (sqrt(M_PI) * (double)brdf.gloss.width_weft),
                    0.02 / (double)brdf.gloss.width_weft);
        for (size_t k = 0; k < TL_COUNT(views); k++) {
            double dark = tl_brdf_table_ratio(&brdf, &clamped, views[k]);
            double kept = tl_brdf_table_ratio(&brdf, &scaled, views[k]);
            /* Half a step of 255, against the factor where half the light is masked; of the first table too.
             */
            double factor = fmin(1 / (M_PI * (double)views[k]), (double)scaled.tables[1].scale) / 2;
            double bound = 0.5 / 255 * (double)scaled.tables[1].scale / factor + 0.01;
            printf("%5.2f %8.2f %8.3f %9.3f %8.3f\n", (double)glossiness[i], (double)views[k], dark, kept,
                   bound);
            assert_near(kept, 1, bound);
            assert_true(dark < 1.01);
        }
        double grazing = tl_brdf_table_ratio(&brdf, &clamped, 0.03f);
        assert_true(grazing < 0.8 * before); /* shinier is darker */
        before = grazing;
        tl_brdf_tables_release(&clamped);
        tl_brdf_tables_release(&scaled);
    }
}

/* By V-grooves the factor has no bound: a constant between is better in 8 bits than either end. */
static void constants_trade_grazing_views_for_steps(void **state)
{
    (void)state;
    struct tl_brdf brdf = brdf_of(TL_REFLECT_TORRANCE_SPARROW, 0.9f, TL_FRESNEL_SCHLICK);
    brdf.gloss.masking = TL_MASKING_V_GROOVES;
    const float constants[] = {1, 4, 16, 0};
    struct tl_table_error errors[TL_COUNT(constants)];
    for (size_t i = 0; i < TL_COUNT(constants); i++) {
        struct tl_brdf_table_params params = {
            .size = 512, .range = TL_RANGE_SCALED, .constant = constants[i]};
        errors[i] = tl_brdf_table_error(&brdf, &params);
        printf("v_grooves, 8 bits, constant %4.0f: %.2f %% away, %.2f %% grazing, %.1f %% too dark there\n",
               (double)constants[i], 100 * errors[i].steep, 100 * errors[i].grazing,
               100 * errors[i].darkening);
    }
    assert_true(errors[1].darkening < errors[0].darkening / 2);
    assert_true(errors[1].steep < errors[3].steep / 5);
    assert_true(errors[1].steep < errors[0].steep / 5); /* 1 / (pi n.v) is above 1 from 71 degrees on */
}

/* Ambient, diffuse and gloss from one look-up. */
static void folded_tables_hold_three_terms(void **state)
{
    (void)state;
    for (int model = 0; model <= TL_REFLECT_COSINE_LOBE; model++) {
        struct tl_brdf brdf = brdf_of(model, 0.9f, TL_FRESNEL_SCHLICK);
        struct tl_brdf_table_params params = {.size = 512,
                                              .precision = TL_PRECISION_FLOAT,
                                              .folded = true,
                                              .ambient = {{0.02f, 0.03f, 0.01f}},
                                              .diffuse = {{0.5f, 0.3f, 0.6f}}};
        struct tl_table_error error = tl_brdf_table_error(&brdf, &params);
        printf("%s, folded: %.4f %%\n", names[model], 100 * error.steep);
        assert_true(error.steep <= 0.005);
        struct tl_brdf_tables tables = tl_brdf_tables_make(&brdf, &params);
        assert_int_equal(tables.count, 1);
        float inputs[TL_AXIS_COUNT] = {[TL_AXIS_N_DOT_V] = 0.5f,
                                       [TL_AXIS_N_DOT_L] = -0.2f,
                                       [TL_AXIS_R_DOT_L] = 1,
                                       [TL_AXIS_N_DOT_H] = 1};
        assert_near(tl_brdf_tables_gloss(&tables, inputs).y, 0.03, 1e-6); /* turned away: ambient alone */
        tl_brdf_tables_release(&tables);
    }
}

/* GL_LINEAR between texel centres, GL_CLAMP_TO_EDGE outside. */
static void look_ups_are_those_of_gl(void **state)
{
    (void)state;
    float texels[] = {1, 2, 4, 10, 20, 40};
    struct tl_brdf_table table = {.width = 3,
                                  .height = 2,
                                  .channels = 1,
                                  .precision = TL_PRECISION_FLOAT,
                                  .texels = texels,
                                  .scale = 2};
    assert_near(tl_brdf_table_at(&table, 0.5f / 3, 0.25f).x, 2, 1e-6);
    assert_near(tl_brdf_table_at(&table, 2.5f / 3, 0.75f).z, 80, 1e-5);
    assert_near(tl_brdf_table_at(&table, 1.0f / 3, 0.25f).x, 3, 1e-6);
    assert_near(tl_brdf_table_at(&table, 1.0f / 3, 0.5f).x, 2 * (1 + 2 + 10 + 20) / 4.0, 1e-5);
    assert_near(tl_brdf_table_at(&table, -7, 9).x, 20, 1e-6);
    assert_near(tl_brdf_table_at(&table, NAN, 0).x, 2, 1e-6);
    uint8_t bytes[] = {0, 255, 51, 0, 0, 0};
    table = (struct tl_brdf_table){.width = 2, .height = 1, .channels = 3, .texels = bytes, .scale = 1};
    vec3s half = tl_brdf_table_at(&table, 0.5f, 0.3f);
    assert_near(half.y, 0.5, 1e-6);
    assert_near(half.z, 0.1, 1e-6);
}

/* Any size, any precision: the bytes are what the texels take, and a table of two is a table. */
static void sizes_are_free(void **state)
{
    (void)state;
    for (int model = 0; model < MODELS; model++) {
        for (int size = 2; size < 80; size = 2 * size + 1) {
            struct tl_brdf brdf = brdf_of(model, 0.7f, TL_FRESNEL_DIELECTRIC);
            struct tl_brdf_table_params params = {.size = size, .precision = size % 3};
            struct tl_table_error error = tl_brdf_table_error(&brdf, &params);
            size_t squares = model == TL_REFLECT_TORRANCE_SPARROW ? 4
                             : model == TL_REFLECT_WARD           ? 2
                             : model == TL_REFLECT_BANKS          ? 1
                                                                  : 3;
            size_t lines = model >= TL_REFLECT_WARD ? 3 : 0, area = (size_t)size * (size_t)size;
            assert_int_equal(error.bytes, (squares * area + lines * (size_t)size) << params.precision);
            assert_true(isfinite(error.steep) && isfinite(error.grazing));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(float_tables_are_the_formula),
        cmocka_unit_test(near_mirrors_are_exact_up_to_the_stated_exponent),
        cmocka_unit_test(every_torrance_sparrow_holds),
        cmocka_unit_test(banks_by_angles_is_finer),
        cmocka_unit_test(scaling_keeps_what_clamping_darkens),
        cmocka_unit_test(constants_trade_grazing_views_for_steps),
        cmocka_unit_test(folded_tables_hold_three_terms),
        cmocka_unit_test(look_ups_are_those_of_gl),
        cmocka_unit_test(sizes_are_free),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
