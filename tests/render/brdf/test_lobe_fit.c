/* Sets of lobes against the gloss that they stand for, by brute force over the hemisphere: how much of the
 * light is sent elsewhere (L1 over the gloss's own integral), and that none is lost. */
#include "render/brdf/lobe_fit.h"

#include "tests/testing.h"

#include "config/base/memory.h"
#include "render/env/exponent.h"

#include <math.h>

#define RINGS   180 /* about the mirror direction, closer to one another near it */
#define SECTORS 360
#define RUNS    5 /* numbers of lobes */

/* Fifteen points for the albedo, and a Gaussian's share above the horizon for a power's. The threads' albedo
 * leaves the horizon out. */
#define ENERGY_OFF         0.05
#define ENERGY_OFF_THREADS 0.2
#define ENERGY_OFF_TAILS   0.02 /* of GGX: between rows of the table */

/* The bounds are measured errors, rounded up; they detect changes that make the fit worse. test_layered
 * compares images with the reference. */
struct gloss_case {
    const char *name;
    int model;
    float weft, warp, glossiness;
    double error[RUNS]; /* L1 with 1, 3, 5, 7 and 11 lobes, mean over the viewers */
    int facets;         /* 0: Beckmann's */
    int masking;
    float f0;      /* 0: white */
    double energy; /* how far off it may be; 0: as above */
};

static const struct gloss_case cases[] = {
    {.name = "ward .15 .15", TL_REFLECT_WARD, 0.15f, 0.15f, 0, {0.58, 0.22, 0.14, 0.12, 0.12}},
    {.name = "ward .30 .15", TL_REFLECT_WARD, 0.30f, 0.15f, 0, {0.74, 0.27, 0.16, 0.15, 0.14}},
    {.name = "ward .40 .10", TL_REFLECT_WARD, 0.40f, 0.10f, 0, {0.92, 0.55, 0.28, 0.18, 0.15}},
    {.name = "ward .10 .40", TL_REFLECT_WARD, 0.10f, 0.40f, 0, {0.92, 0.55, 0.28, 0.18, 0.15}},
    {.name = "ward .40 .05", TL_REFLECT_WARD, 0.40f, 0.05f, 0, {1.13, 0.94, 0.60, 0.39, 0.21}},
    {.name = "torrance-sparrow .2", TL_REFLECT_TORRANCE_SPARROW, 0.2f, 0, 0, {0.53, 0.20, 0.14, 0.13, 0.13}},
    {.name = "torrance-sparrow .4", TL_REFLECT_TORRANCE_SPARROW, 0.4f, 0, 0, {0.57, 0.21, 0.20, 0.20, 0.20}},
    {.name = "ggx .01",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 0.01f,
     .error = {0.68, 0.39, 0.25, 0.19, 0.19},
     .facets = TL_FACETS_GGX},
    {.name = "ggx .04",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 0.04f,
     .error = {0.66, 0.37, 0.23, 0.17, 0.17},
     .facets = TL_FACETS_GGX},
    {.name = "ggx .1",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 0.1f,
     .error = {0.63, 0.31, 0.17, 0.12, 0.12},
     .facets = TL_FACETS_GGX},
    {.name = "ggx .2",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 0.2f,
     .error = {0.56, 0.22, 0.10, 0.07, 0.07},
     .facets = TL_FACETS_GGX},
    {.name = "ggx .3",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 0.3f,
     .error = {0.49, 0.14, 0.06, 0.06, 0.06},
     .facets = TL_FACETS_GGX},
    {.name = "ggx .45",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 0.45f,
     .error = {0.38, 0.08, 0.04, 0.04, 0.04},
     .facets = TL_FACETS_GGX},
    {.name = "ggx .6",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 0.6f,
     .error = {0.27, 0.07, 0.05, 0.06, 0.06},
     .facets = TL_FACETS_GGX},
    {.name = "ggx 1",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 1.0f,
     .error = {0.22, 0.14, 0.15, 0.15, 0.15},
     .facets = TL_FACETS_GGX},
    {.name = "ggx .3, grooves",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 0.3f,
     .error = {0.53, 0.17, 0.10, 0.09, 0.09},
     .facets = TL_FACETS_GGX,
     .masking = TL_MASKING_V_GROOVES,
     .energy = 0.2},
    {.name = "ggx .3, schlick",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 0.3f,
     .error = {0.53, 0.17, 0.10, 0.09, 0.09},
     .facets = TL_FACETS_GGX,
     .masking = TL_MASKING_SCHLICK,
     .energy = 0.2},
    {.name = "ggx .2, plastic",
     .model = TL_REFLECT_TORRANCE_SPARROW,
     .weft = 0.2f,
     .error = {0.63, 0.27, 0.16, 0.14, 0.14},
     .facets = TL_FACETS_GGX,
     .f0 = 0.04f,
     .energy = 0.04},
    {.name = "blinn-phong s 8", TL_REFLECT_BLINN_PHONG, 0, 0, 0.875f, {0.52, 0.19, 0.15, 0.15, 0.15}},
    {.name = "cosine lobe s 8", TL_REFLECT_COSINE_LOBE, 0, 0, 0.875f, {0.20, 0.20, 0.20, 0.20, 0.20}},
    {.name = "banks s 8", TL_REFLECT_BANKS, 0, 0, 0.875f, {0.63, 0.27, 0.25, 0.25, 0.26}},
    {.name = "banks s 32", TL_REFLECT_BANKS, 0, 0, 0.96875f, {1.01, 0.56, 0.29, 0.20, 0.18}},
};

static const struct tl_brdf_frame frame = {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};

static struct tl_brdf brdf_of(const struct gloss_case *item)
{
    tl_material material = tl_material_default("test");
    material.glossiness = item->glossiness;
    material.gloss.model = item->model;
    material.gloss.facets = item->facets ? item->facets : TL_FACETS_BECKMANN;
    material.gloss.masking = item->masking;
    material.gloss.width_weft = item->weft;
    material.gloss.width_warp = item->warp;
    const float f0 = item->f0 > 0 ? item->f0 : 1;
    return tl_brdf_of(&material, (vec3s){{f0, f0, f0}}, item->glossiness);
}

static vec3s from_angles(float polar, float azimuth)
{
    return (vec3s){{sinf(polar) * cosf(azimuth), sinf(polar) * sinf(azimuth), cosf(polar)}};
}

struct sums {
    double gloss, lobes_sum, difference;
};

static struct sums integrate(const struct tl_brdf *brdf, vec3s v, const struct tl_fitted_lobe *lobes,
                             int count)
{
    struct sums sums = {0};
    const vec3s axis = {{-v.x, -v.y, v.z}};
    const vec3s across = glms_vec3_normalize(glms_vec3_cross(axis, (vec3s){{0.6f, 0.8f, 0}}));
    const vec3s along = glms_vec3_cross(axis, across);
    for (int ring = 0; ring < RINGS; ring++) {
        const double root = (ring + 0.5) / RINGS, angle = M_PI * root * root;
        const double part = sin(angle) * 2 * M_PI * root / RINGS * 2 * M_PI / SECTORS;
        for (int sector = 0; sector < SECTORS; sector++) {
            const double turn = 2 * M_PI * (sector + 0.5) / SECTORS;
            vec3s l = glms_vec3_scale(axis, (float)cos(angle));
            l = glms_vec3_muladds(along, (float)(sin(angle) * cos(turn)), l);
            l = glms_vec3_muladds(across, (float)(sin(angle) * sin(turn)), l);
            if (!(l.z > 0))
                continue;
            double gloss = (double)tl_brdf_gloss(brdf, &frame, l, v).x, lobes_sum = 0;
            for (int k = 0; k < count; k++)
                lobes_sum +=
                    (double)(lobes[k].weight.x *
                             tl_lobe_cosine(lobes[k].exponent, glms_vec3_dot(lobes[k].direction, l)));
            sums.gloss += part * gloss;
            sums.lobes_sum += part * lobes_sum;
            sums.difference += part * fabs(gloss - lobes_sum);
        }
    }
    return sums;
}

static void test_lobes_match_the_gloss(void **state)
{
    (void)state;
    const int counts[RUNS] = {1, 3, 5, 7, TL_LOBE_FIT_MAX};
    const float polars[] = {0, 0.5f, 1, 1.3f, 1.4f}, azimuths[] = {0, 0.785f, 1.571f};
    printf("%-22s %33s   energy, least and greatest\n",
           "L1, percent, of lobes:", "1      3      5      7     11");
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        struct tl_brdf brdf = brdf_of(&cases[i]);
        double minimum = 2, maximum = 0, errors[RUNS];
        for (int n = 0; n < RUNS; n++) {
            double sum = 0;
            for (size_t p = 0; p < TL_COUNT(polars); p++)
                for (size_t a = 0; a < (p == 0 ? 1 : TL_COUNT(azimuths)); a++) {
                    vec3s v = from_angles(polars[p], azimuths[a]);
                    struct tl_fitted_lobe lobes[TL_LOBE_FIT_MAX];
                    int count = tl_lobe_fit_make(&brdf, &frame, v, 1, counts[n], lobes);
                    struct sums sums = integrate(&brdf, v, lobes, count);
                    sum += sums.difference / sums.gloss;
                    minimum = fmin(minimum, sums.lobes_sum / sums.gloss);
                    maximum = fmax(maximum, sums.lobes_sum / sums.gloss);
                }
            const size_t directions = 1 + (TL_COUNT(polars) - 1) * TL_COUNT(azimuths);
            errors[n] = sum / (double)directions;
        }
        for (int n = 0; n < RUNS; n++)
            assert_true(errors[n] < cases[i].error[n]);
        double off = cases[i].energy > 0                  ? cases[i].energy
                     : cases[i].model == TL_REFLECT_BANKS ? ENERGY_OFF_THREADS
                     : cases[i].facets                    ? ENERGY_OFF_TAILS
                                                          : ENERGY_OFF;
        assert_true(minimum > 1 - off && maximum < 1 + off);
        printf("%-22s %6.1f %6.1f %6.1f %6.1f %6.1f   %.3f %.3f\n", cases[i].name, 100 * errors[0],
               100 * errors[1], 100 * errors[2], 100 * errors[3], 100 * errors[4], minimum, maximum);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_lobes_match_the_gloss)};
    return cmocka_run_group_tests_name("lobe_fit", tests, NULL, NULL);
}
