/* Tables factored out of samples: a product that tables can hold, models of which the samples are made, gaps,
 * and samples that no tables can have. Row A13. */
#include "render/brdf/tables/factor.h"

#include "config/base/memory.h"

#include "tests/testing.h"

#include <stdlib.h>
#include <string.h>

static const struct tl_brdf_frame frame = {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};

static struct tl_brdf brdf_of(int model)
{
    tl_material material = tl_material_default("test");
    material.glossiness = 0.9f;
    material.gloss = (struct tl_gloss){
        .model = model, .facets = TL_FACETS_BECKMANN, .width_weft = 0.3f, .width_warp = 0.15f, .index = 1.5f};
    return tl_brdf_of(&material, (vec3s){{0.2f, 0.2f, 0.2f}}, 0.9f);
}

static vec3s from_tables(const struct tl_brdf_tables *tables, vec3s l, vec3s v)
{
    float inputs[TL_AXIS_COUNT];
    tl_brdf_inputs(&frame, l, v, inputs);
    return tl_brdf_tables_gloss(tables, inputs);
}

/* Relative RMSE of f_r cos a over samples of which neither direction is lower than a cosine. */
static double error_at(const struct tl_brdf_tables *tables, const struct tl_reflectance_samples *at,
                       float lowest)
{
    double off = 0, all = 0;
    for (size_t i = 0; i < at->count; i++) {
        const struct tl_reflectance_sample *sample = &at->items[i];
        if (fminf(sample->l.z, sample->v.z) < lowest)
            continue;
        vec3s wanted = glms_vec3_scale(sample->value, sample->l.z);
        off += (double)glms_vec3_norm2(glms_vec3_sub(from_tables(tables, sample->l, sample->v), wanted));
        all += (double)glms_vec3_norm2(wanted);
    }
    return sqrt(off / all);
}

/* Pairs of directions that are none of the samples': those of the sequence after them. */
static struct tl_reflectance_samples others_of(const struct tl_brdf *brdf, size_t skipped)
{
    struct tl_reflectance_samples others = tl_brdf_model_samples(brdf, skipped + 10000);
    others.count -= skipped;
    memmove(others.items, others.items + skipped, others.count * sizeof *others.items);
    return others;
}

/* Limits in the order of the sizes; the largest tables of one model. Ward's product is the tables' own but
 * for their resolution, Torrance and Sparrow's masking and the cosine lobe's r.l nearly; error falls as
 * texels get smaller. Phong's and Blinn's models are not reciprocal, as every product of this form is: what
 * is left is bounded, not small. The limits are what came out, with a quarter to spare. */
static void models_come_back(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int model;
        double limits[3];
    } cases[] = {{"ward", TL_REFLECT_WARD, {0.04, 0.012, 0.005}},
                 {"torrance_sparrow", TL_REFLECT_TORRANCE_SPARROW, {0.03, 0.01}},
                 {"cosine_lobe", TL_REFLECT_COSINE_LOBE, {0.07, 0.025}},
                 {"phong", TL_REFLECT_PHONG, {0.13, 0.13}},
                 {"blinn_phong", TL_REFLECT_BLINN_PHONG, {0.25, 0.25}}};
    for (size_t m = 0; m < TL_COUNT(cases); m++)
        for (int k = 0; k < 3 && cases[m].limits[k] > 0; k++) {
            struct tl_brdf brdf = brdf_of(cases[m].model);
            const size_t counts[] = {10000, 40000, 100000};
            struct tl_reflectance_samples samples = tl_brdf_model_samples(&brdf, counts[k]);
            struct tl_reflectance_samples others = others_of(&brdf, counts[k]);
            struct tl_brdf_tables tables =
                tl_brdf_tables_factor(&samples, tl_factor_size(samples.count), NULL);
            double off = error_at(&tables, &others, 0.1f);
            print_message("%s, tables of %d: relative RMSE %.4f at the samples, %.4f elsewhere\n",
                          cases[m].name, tables.tables[2].width, error_at(&tables, &samples, 0), off);
            assert_int_equal(tables.tables[2].width, 32 << k);
            assert_true(off < cases[m].limits[k]);
            tl_brdf_tables_release(&tables);
            tl_reflectance_samples_release(&samples);
            tl_reflectance_samples_release(&others);
        }
}

/* Multiplies the texels of a table by a wave over it. The two tables over directions get the same. */
static void wave(struct tl_brdf_table *table, float amount)
{
    float *texels = table->texels;
    for (int j = 0; j < table->height; j++)
        for (int i = 0; i < table->width; i++)
            for (int c = 0; c < table->channels; c++)
                texels[(j * table->width + i) * table->channels + c] *=
                    1 + amount * sinf(7.0f * (float)i / (float)table->width + (float)c) *
                            cosf(5.0f * (float)j / (float)table->height + 1);
}

/* Samples of a product of tables of the same size give that product back, at the samples and elsewhere, by
 * channels of their own, and without any symmetry. What is off is the weight of second differences: a
 * hundredth of it and three times as many steps leave a quarter of the error. */
static void a_product_is_found_again(void **state)
{
    (void)state;
    struct tl_brdf brdf = brdf_of(TL_REFLECT_WARD);
    brdf.gloss.width_weft = brdf.gloss.width_warp = 0.7f;
    brdf.f0 = (vec3s){{0.3f, 0.2f, 0.1f}};
    struct tl_reflectance_samples samples = tl_brdf_model_samples(&brdf, 12000),
                                  others = others_of(&brdf, 12000);
    struct tl_brdf_tables truth = tl_brdf_tables_factor(&samples, 32, NULL);
    for (int t = 0; t < truth.count; t++)
        wave(&truth.tables[t], t < 2 ? 0.2f : 0.4f);
    struct tl_reflectance_samples *both[] = {&samples, &others};
    for (size_t k = 0; k < 2; k++)
        for (size_t i = 0; i < both[k]->count; i++) {
            struct tl_reflectance_sample *sample = &both[k]->items[i];
            sample->value = glms_vec3_scale(from_tables(&truth, sample->l, sample->v), 1 / sample->l.z);
        }
    struct tl_brdf_tables found = tl_brdf_tables_factor(&samples, 32, NULL);
    double there = error_at(&found, &samples, 0), elsewhere = error_at(&found, &others, 0.1f);
    print_message("a product of tables: relative RMSE %.1e at the samples, %.1e elsewhere\n", there,
                  elsewhere);
    assert_true(there < 5e-3 && elsewhere < 5e-3);
    tl_brdf_tables_release(&truth);
    tl_brdf_tables_release(&found);
    tl_reflectance_samples_release(&samples);
    tl_reflectance_samples_release(&others);
}

/* A matt sheet measured in one plane only, at 5 degrees' steps: the planes between are bridged with its own
 * value, and the report says how much is. */
static void gaps_are_bridged(void **state)
{
    (void)state;
    struct tl_reflectance_samples samples = {TL_NEW_ARRAY(struct tl_reflectance_sample, 33 * 33), 0};
    for (int i = -16; i <= 16; i++)
        for (int k = -16; k <= 16; k++) {
            float a = glm_rad(5.0f * (float)i), b = glm_rad(5.0f * (float)k);
            samples.items[samples.count++] = (struct tl_reflectance_sample){
                {{sinf(a), 0, cosf(a)}}, {{sinf(b), 0, cosf(b)}}, {{0.25f, 0.25f, 0.25f}}};
        }
    double bridged;
    struct tl_brdf_tables tables = tl_brdf_tables_factor(&samples, tl_factor_size(samples.count), &bridged);
    print_message("one plane: %.0f %% bridged\n", 100 * bridged);
    assert_true(bridged > 0.5 && bridged < 1);
    for (int i = 0; i < 100; i++) {
        float a = 0.013f * (float)i, turn = 0.7f * (float)i;
        vec3s l = {{sinf(a) * cosf(turn), sinf(a) * sinf(turn), cosf(a)}}, v = {{0, 0.6f, 0.8f}};
        assert_near(from_tables(&tables, l, v).x, 0.25f * l.z, 1e-3);
    }
    tl_brdf_tables_release(&tables);
    tl_reflectance_samples_release(&samples);
}

/* Samples near the normal only, which get brighter towards their border by e for every two degrees: beyond it
 * the tables do not go on rising, by e^30, as a line through the logarithms would. */
static void nothing_rises_where_nothing_was_measured(void **state)
{
    (void)state;
    struct tl_reflectance_samples samples = {TL_NEW_ARRAY(struct tl_reflectance_sample, 2000), 2000};
    float maximum = 0;
    for (size_t i = 0; i < samples.count; i++) {
        float a = glm_rad(20 * sqrtf((float)(i % 50) / 50)),
              b = glm_rad(20 * sqrtf((float)(i * 7 % 41) / 41));
        float turn = 2.4f * (float)i, other = 1.7f * (float)i, value = expf(glm_deg(a + b) / 2);
        samples.items[i] =
            (struct tl_reflectance_sample){{{sinf(a) * cosf(turn), sinf(a) * sinf(turn), cosf(a)}},
                                           {{sinf(b) * cosf(other), sinf(b) * sinf(other), cosf(b)}},
                                           {{value, value, value}}};
        maximum = fmaxf(maximum, value);
    }
    struct tl_brdf_tables tables = tl_brdf_tables_factor(&samples, 16, NULL);
    float highest = 0;
    for (int i = 0; i < 500; i++) {
        float turn = 0.7f * (float)i, height = 0.1f + 0.001f * (float)i, plane = sqrtf(1 - height * height);
        vec3s l = {{plane * cosf(turn), plane * sinf(turn), height}},
              v = {{plane * cosf(3 * turn), plane * sinf(3 * turn), height}};
        highest = fmaxf(highest, from_tables(&tables, l, v).x);
    }
    print_message("outside of the samples: %.3g, largest sample %.3g\n", (double)highest, (double)maximum);
    assert_true(highest < 1e4f * maximum);
    tl_brdf_tables_release(&tables);
    tl_reflectance_samples_release(&samples);
}

/* One value repeated, values of six orders, samples at the horizon: whatever they are, what is read is finite
 * and not negative in every direction, and the same when it is made again. */
static void tables_are_finite_and_the_same_again(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        struct tl_reflectance_samples samples = {TL_NEW_ARRAY(struct tl_reflectance_sample, 2000), 2000};
        uint32_t seed = 1;
        for (size_t i = 0; i < samples.count; i++) {
            float at[5];
            for (int d = 0; d < 5; d++)
                at[d] = kind == 0 ? 0.3f : (float)((seed = 1664525 * seed + 1013904223) >> 8) / 16777216;
            float zl = kind == 2 ? 0 : at[0], zv = at[1], rl = sqrtf(1 - zl * zl), rv = sqrtf(1 - zv * zv);
            float value = kind == 0 ? 1 : powf(10, 6 * at[4]) * (at[4] < 0.2f ? 0.0f : 1.0f);
            samples.items[i] =
                (struct tl_reflectance_sample){{{rl * cosf(6.28f * at[2]), rl * sinf(6.28f * at[2]), zl}},
                                               {{rv * cosf(6.28f * at[3]), rv * sinf(6.28f * at[3]), zv}},
                                               {{value, 0, 2 * value}}};
        }
        struct tl_brdf_tables first = tl_brdf_tables_factor(&samples, 16, NULL),
                              again = tl_brdf_tables_factor(&samples, 16, NULL);
        for (int t = 0; t < first.count; t++)
            assert_memory_equal(first.tables[t].texels, again.tables[t].texels,
                                (size_t)(first.tables[t].width * first.tables[t].height) * 3 * sizeof(float));
        for (int i = 0; i < 2000; i++) {
            vec3s l = glms_vec3_normalize(
                (vec3s){{sinf((float)i), cosf(3.0f * (float)i), 0.02f + (float)(i % 10)}});
            vec3s v =
                glms_vec3_normalize((vec3s){{cosf((float)i), cosf(5.0f * (float)i), 0.02f + (float)(i % 7)}});
            vec3s value = from_tables(&first, l, v);
            for (int c = 0; c < 3; c++)
                assert_true(isfinite(value.raw[c]) && value.raw[c] >= 0);
        }
        tl_brdf_tables_release(&first);
        tl_brdf_tables_release(&again);
        tl_reflectance_samples_release(&samples);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_come_back),
        cmocka_unit_test(a_product_is_found_again),
        cmocka_unit_test(gaps_are_bridged),
        cmocka_unit_test(nothing_rises_where_nothing_was_measured),
        cmocka_unit_test(tables_are_finite_and_the_same_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
