/* Lobes from the table, and Ward's as they are fitted to many pixels at once, against the fit that they stand
 * for, over viewers, reflectances and glossiness: their
 * albedo, which is the sum of their weights, their exponent, and the light that they fetch from a smooth
 * environment whose convolution with a lobe is known. */
#include "render/brdf/ward_lanes.h"
#include "tests/render/shade/lobe_set_look_up.h"

#include "tests/testing.h"

#include "config/base/memory.h"
#include "render/reference/random.h"

#include <math.h>
#include <string.h>

#define VIEWERS  4000
#define LOBES    5    /* of the option light.lobes */
#define GRAZING  0.1f /* cosine; a pixel in fifty of a figure is seen at a smaller one */
#define CHANNELS 3

/* What has facets and a table. The bounds are measured errors and a third of them; they detect a table
 * that became worse. The largest errors lie where the fit changes its number of lobes from one viewer to the
 * next; test_pixels.c measures the error of the image. */
struct lobe_set_case {
    const char *name;
    int model, facets, fresnel;
    float weft, warp;   /* 0: from glossiness */
    float gloss[2];     /* of the table */
    double mean, worst; /* of the light, away from grazing viewers, relative */
    double grazing;     /* mean of the light of the others */
};

static const struct lobe_set_case cases[] = {
    {"torrance-sparrow .2",
     TL_REFLECT_TORRANCE_SPARROW,
     TL_FACETS_BECKMANN,
     0,
     0.2f,
     0,
     {0.9f, 0.9f},
     0.002,
     0.11,
     0.001},
    {"torrance-sparrow by glossiness",
     TL_REFLECT_TORRANCE_SPARROW,
     TL_FACETS_BECKMANN,
     0,
     0,
     0,
     {0.5f, 0.95f},
     0.007,
     1.24,
     0.004},
    {"torrance-sparrow .3, gold",
     TL_REFLECT_TORRANCE_SPARROW,
     TL_FACETS_GAUSSIAN,
     TL_FRESNEL_CONDUCTOR,
     0.3f,
     0,
     {0.9f, 0.9f},
     0.002,
     0.22,
     0.002},
    {"ggx .16", TL_REFLECT_TORRANCE_SPARROW, TL_FACETS_GGX, 0, 0.16f, 0, {0.9f, 0.9f}, 0.001, 0.0065, 0.0008},
    {"ggx by glossiness",
     TL_REFLECT_TORRANCE_SPARROW,
     TL_FACETS_GGX,
     0,
     0,
     0,
     {0.5f, 0.95f},
     0.0026,
     0.045,
     0.0047},
    {"blinn-phong", TL_REFLECT_BLINN_PHONG, 0, 0, 0, 0, {0.5f, 0.95f}, 0.0135, 1.42, 0.003},
    {"banks", TL_REFLECT_BANKS, 0, 0, 0, 0, {0.75f, 0.95f}, 0.0017, 0.015, 0.0015},
};

static const vec3s reflectances[] = {
    {{0.01f, 0.01f, 0.01f}}, {{0.04f, 0.04f, 0.04f}}, {{0.5f, 0.5f, 0.5f}}, {{0.9f, 0.3f, 0.015f}}};

/* A level that rises to one side, with a wide lamp: 0.3 + 0.2 a.w + 3 K_8(b, w). Convolved with K_s: the
 * first is kept, the second times (s + 1) / (s + 2), and two lobes that are Gaussians of the same widths make
 * one of e^(|8 b + s d| - 8 - s). */
static double environment(vec3s direction, double exponent)
{
    const vec3s a = {{0.48f, 0.6f, 0.64f}}, b = {{-0.6f, 0.64f, 0.48f}};
    double d_a = (double)glms_vec3_dot(a, direction), d_b = (double)glms_vec3_dot(b, direction);
    double length = sqrt(64 + exponent * exponent + 16 * exponent * d_b);
    double lamp = 3 * 8 * exponent / (2 * M_PI * length) * exp(length - 8 - exponent);
    return 0.3 + 0.2 * d_a * (exponent + 1) / (exponent + 2) + lamp;
}

struct fetched {
    double albedo[CHANNELS], light[CHANNELS];
};

static struct fetched fetch(const struct tl_fitted_lobe *lobes, int count)
{
    struct fetched sums = {0};
    for (int k = 0; k < count; k++)
        for (int c = 0; c < CHANNELS; c++) {
            double weight = (double)lobes[k].weight.raw[c];
            sums.albedo[c] += weight;
            sums.light[c] += weight * environment(lobes[k].direction, (double)lobes[k].exponent);
        }
    return sums;
}

struct errors {
    double sum, worst;
    size_t count;
};

static void add_error(struct errors *errors, double value, double expected)
{
    double error = fabs(value / expected - 1);
    errors->sum += error;
    errors->worst = fmax(errors->worst, error);
    errors->count++;
}

/* A frame of any handedness, a viewer above it, and a glossiness of the table. */
struct query {
    struct tl_brdf_frame frame;
    vec3s viewer;
    float cosine, glossiness;
};

static vec3s random_direction(struct tl_random *random)
{
    float z = 2 * (float)tl_random_unit(random) - 1, turn = 2 * (float)M_PI * (float)tl_random_unit(random);
    float radius = sqrtf(1 - z * z);
    return (vec3s){{radius * cosf(turn), radius * sinf(turn), z}};
}

static struct query random_query(const struct lobe_set_case *item, struct tl_random *random)
{
    struct query query = {.glossiness = item->gloss[0] +
                                        (item->gloss[1] - item->gloss[0]) * (float)tl_random_unit(random)};
    vec3s normal = random_direction(random);
    query.frame =
        tl_brdf_frame_make(normal, random_direction(random), tl_random_unit(random) < 0.5 ? 1 : -1, 0);
    do {
        query.viewer = random_direction(random);
        query.cosine = glms_vec3_dot(query.viewer, normal);
    } while (query.cosine < 0.02f);
    return query;
}

static tl_material material_of(const struct lobe_set_case *item)
{
    tl_material material = tl_material_default("test");
    material.glossiness = item->gloss[1];
    material.gloss.model = item->model;
    material.gloss.facets = item->facets;
    material.gloss.fresnel = item->fresnel;
    material.gloss.index = 0.3f;
    material.gloss.extinction = 2.8f;
    material.gloss.width_weft = item->weft;
    material.gloss.width_warp = item->warp;
    return material;
}

struct case_errors {
    struct errors albedo, light, grazing, exponent;
};

static void compare(const struct lobe_set_case *item, const struct tl_lobe_set_table *table,
                    struct tl_random *random, struct case_errors *errors)
{
    const tl_material material = material_of(item);
    struct query query = random_query(item, random);
    struct tl_fitted_lobe fitted[TL_LOBE_FIT_MAX], found[TL_LOBE_FIT_MAX];
    for (size_t i = 0; i < TL_COUNT(reflectances); i++) {
        struct tl_brdf brdf = tl_brdf_of(&material, reflectances[i], query.glossiness);
        int count =
            tl_lobe_fit_make(&brdf, &query.frame, query.viewer, table->lobe_count, table->lobe_count, fitted);
        int known =
            look_lobe_set_up(table, &query.frame, query.viewer, reflectances[i], query.glossiness, found);
        struct fetched is = fetch(found, known), want = fetch(fitted, count);
        bool grazing = query.cosine < GRAZING;
        for (int c = 0; c < CHANNELS; c++) {
            add_error(grazing ? &errors->grazing : &errors->light, is.light[c], want.light[c]);
            if (!grazing)
                add_error(&errors->albedo, is.albedo[c], want.albedo[c]);
        }
        if (!grazing)
            add_error(&errors->exponent, (double)found[known / 2].exponent,
                      (double)fitted[count / 2].exponent);
    }
}

static double mean_of(const struct errors *errors)
{
    return errors->sum / (double)errors->count;
}

static void test_table_matches_the_fit(void **state)
{
    (void)state;
    printf("%-32s %-16s %-16s %-16s\n", "percent, mean and worst:", "albedo", "light", "light, grazing");
    for (size_t k = 0; k < TL_COUNT(cases); k++) {
        const struct lobe_set_case *item = &cases[k];
        const tl_material material = material_of(item);
        struct tl_random random = tl_random_begin(18, k + 3);
        struct tl_lobe_set_table table;
        struct case_errors errors = {0};
        tl_lobe_set_table_make(&material, item->gloss[0], item->gloss[1], LOBES, &table);
        for (int i = 0; i < VIEWERS; i++)
            compare(item, &table, &random, &errors);
        tl_lobe_set_table_release(&table);
        printf("%-32s %6.3f %8.2f  %6.3f %8.2f  %6.3f %8.2f  exponent %.3f %.2f\n", item->name,
               100 * mean_of(&errors.albedo), 100 * errors.albedo.worst, 100 * mean_of(&errors.light),
               100 * errors.light.worst, 100 * mean_of(&errors.grazing), 100 * errors.grazing.worst,
               100 * mean_of(&errors.exponent), 100 * errors.exponent.worst);
        assert_near(mean_of(&errors.light), 0, item->mean);
        assert_near(errors.light.worst, 0, item->worst);
        assert_near(mean_of(&errors.grazing), 0, item->grazing);
    }
}

static const struct lobe_set_case ward_cases[] = {
    {"ward .3 .1, satin", TL_REFLECT_WARD, 0, 0, 0.3f, 0.1f, {0.9f, 0.95f}, 1e-5, 1e-3, 1e-5},
    {"ward .1 .4", TL_REFLECT_WARD, 0, 0, 0.1f, 0.4f, {0.9f, 0.95f}, 1e-5, 1e-3, 1e-5},
    {"ward by glossiness", TL_REFLECT_WARD, 0, 0, 0, 0, {0.5f, 0.95f}, 1e-5, 1e-3, 1e-5},
    {"ward .2 .06, glass",
     TL_REFLECT_WARD,
     0,
     TL_FRESNEL_DIELECTRIC,
     0.2f,
     0.06f,
     {0.9f, 0.95f},
     1e-5,
     1e-3,
     1e-5},
};

/* The lobes of one pixel of many: towards a viewer in the frame of the threads. */
static int fit_lanes(const struct tl_brdf *brdf, const struct query *query, struct tl_fitted_lobe *lobes)
{
    struct tl_ward_lanes ward;
    const struct tl_brdf_frame *frame = &query->frame;
    memset(&ward, 0, sizeof ward);
    ward.gloss = &brdf->gloss;
    for (int i = 0; i < TL_LANES; i++) {
        ward.viewer[0][i] = glms_vec3_dot(frame->tangent, query->viewer);
        ward.viewer[1][i] = glms_vec3_dot(frame->bitangent, query->viewer);
        ward.viewer[2][i] = query->cosine;
        ward.square[0][i] = brdf->gloss.width_weft * brdf->gloss.width_weft;
        ward.square[1][i] = brdf->gloss.width_warp * brdf->gloss.width_warp;
    }
    const int lane = 5;
    tl_ward_fit(&ward, LOBES, TL_LANES);
    for (int k = 0; k < ward.count; k++) {
        vec3s d = glms_vec3_scale(frame->tangent, ward.local[k][0][lane]);
        d = glms_vec3_add(d, glms_vec3_scale(frame->bitangent, ward.local[k][1][lane]));
        lobes[k].direction = glms_vec3_add(d, glms_vec3_scale(frame->normal, ward.local[k][2][lane]));
        lobes[k].exponent = ward.exponent[k][lane];
        for (int c = 0; c < CHANNELS; c++) {
            bool is_schlick = brdf->gloss.fresnel == TL_FRESNEL_SCHLICK;
            float f0 = brdf->f0.raw[c], missing = is_schlick ? fminf(50 * f0, 1) - f0 : 0;
            float all = f0 * ward.sum[0][lane] + missing * ward.sum[1][lane];
            float scale = all > 0 ? (f0 * ward.albedo[0][lane] + missing * ward.albedo[1][lane]) / all : 0;
            lobes[k].weight.raw[c] = scale * (f0 * ward.plain[k][lane] + missing * ward.away[k][lane]);
        }
    }
    return ward.count;
}

/* The closed form of many pixels at once against the fit, which divides the gloss by a pdf: they differ by
 * rounding, and by a lobe more or less where a viewer lies between two numbers of lobes. */
static void test_lanes_match_the_fit(void **state)
{
    (void)state;
    for (size_t k = 0; k < 2 * TL_COUNT(ward_cases); k++) {
        const struct lobe_set_case *item = &ward_cases[k / 2];
        tl_material material = material_of(item);
        material.gloss.ward = k % 2 ? TL_WARD_BOUNDED : TL_WARD_PUBLISHED;
        struct tl_random random = tl_random_begin(18, k);
        struct errors light = {0}, grazing = {0};
        for (int i = 0; i < VIEWERS; i++) {
            struct query query = random_query(item, &random);
            struct tl_fitted_lobe fitted[TL_LOBE_FIT_MAX], found[TL_LOBE_FIT_MAX];
            struct tl_brdf brdf = tl_brdf_of(&material, reflectances[i % 4], query.glossiness);
            int count = tl_lobe_fit_make(&brdf, &query.frame, query.viewer, 1, LOBES, fitted);
            const int found_count = fit_lanes(&brdf, &query, found);
            struct fetched want = fetch(fitted, count), is = fetch(found, found_count);
            for (int c = 0; c < CHANNELS; c++)
                add_error(query.cosine < GRAZING ? &grazing : &light, is.light[c], want.light[c]);
        }
        printf("%-24s%-8s light off by %.2g, at most %.2g; grazing %.2g, at most %.2g\n", item->name,
               k % 2 ? "bounded" : "", mean_of(&light), light.worst, mean_of(&grazing), grazing.worst);
        assert_near(mean_of(&light), 0, item->mean);
        assert_near(light.worst, 0, item->worst);
        assert_near(mean_of(&grazing), 0, item->grazing);
    }
}

static void test_nothing_below_the_surface(void **state)
{
    (void)state;
    const tl_material material = material_of(&cases[0]);
    const struct tl_brdf_frame frame = {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};
    struct tl_lobe_set_table table;
    struct tl_fitted_lobe lobes[TL_LOBE_FIT_MAX];
    tl_lobe_set_table_make(&material, 0.9f, 0.9f, LOBES, &table);
    assert_int_equal(
        look_lobe_set_up(&table, &frame, (vec3s){{0.6f, 0, -0.8f}}, reflectances[0], 0.9f, lobes), 0);
    assert_int_equal(look_lobe_set_up(&table, &frame, (vec3s){{0.6f, 0, 0.8f}}, reflectances[0], 0.9f, lobes),
                     LOBES);
    tl_lobe_set_table_release(&table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_table_matches_the_fit),
                                       cmocka_unit_test(test_lanes_match_the_fit),
                                       cmocka_unit_test(test_nothing_below_the_surface)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
