/* Light from the inside of threads under light from their surface: by brute force over the hemisphere. */
#include "render/brdf/brdf.h"
#include "render/brdf/facets.h"
#include "render/brdf/lobe_fit.h"

#include "config/base/memory.h"
#include "render/env/exponent.h"

#include "tests/testing.h"

#include <math.h>

#define ROWS    240 /* of the hemisphere, of equal height */
#define COLUMNS 480

static const struct tl_brdf_frame frame = {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}};
static const float polars[] = {0, 0.5f, 1, 1.3f, 1.45f}, azimuths[] = {0, 0.785f, 1.571f};

static vec3s from_angles(float polar, float azimuth)
{
    return (vec3s){{sinf(polar) * cosf(azimuth), sinf(polar) * sinf(azimuth), cosf(polar)}};
}

/* A satin (one system) or a shot silk (two) whose threads send back all light that enters them. */
static tl_material cloth_of(int systems)
{
    tl_material material = tl_material_default("cloth");
    material.specular = (vec3s){{0.045f, 0.045f, 0.045f}};
    material.diffuse = (vec3s){{0.2f, 0.2f, 0.2f}};
    material.gloss = (struct tl_gloss){.model = TL_REFLECT_WARD,
                                       .ward = TL_WARD_BOUNDED,
                                       .width_weft = 0.16f,
                                       .width_warp = systems == 1 ? 0.062f : 0.16f,
                                       .index = 1};
    material.thread_count = systems;
    const float all = 1 / 0.2f;
    material.threads[0] = (struct tl_thread){{{all, all / 2, 0}}, 0.45f, 0.124f};
    material.threads[1] = (struct tl_thread){{{0, all / 2, all}}, 0.14f, 0.45f};
    return material;
}

static struct tl_brdf_sum sum_of(const tl_material *material)
{
    const float none[3] = {0, 0, 0};
    return tl_brdf_sum_of(material, material->specular, material->diffuse, material->glossiness, 1, none);
}

/* Integrals by channel of one lobe, and of the set of lobes that stands for it. */
struct sums {
    double gloss[3], fit[3], off[3];
};

static struct sums integrate(const struct tl_brdf *brdf, vec3s v, const struct tl_fitted_lobe *lobes,
                             int count)
{
    struct sums sums = {0};
    const double part = 2 * M_PI / (ROWS * COLUMNS);
    for (int row = 0; row < ROWS; row++) {
        float z = ((float)row + 0.5f) / ROWS, radius = sqrtf(1 - z * z);
        for (int column = 0; column < COLUMNS; column++) {
            float azimuth = 2 * GLM_PIf * ((float)column + 0.5f) / COLUMNS;
            vec3s l = {{radius * cosf(azimuth), radius * sinf(azimuth), z}};
            vec3s gloss = tl_brdf_gloss(brdf, &frame, l, v), fit = {{0, 0, 0}};
            for (int k = 0; k < count; k++)
                fit = glms_vec3_add(
                    fit,
                    glms_vec3_scale(lobes[k].weight,
                                    tl_lobe_cosine(lobes[k].exponent, glms_vec3_dot(lobes[k].direction, l))));
            for (int c = 0; c < 3; c++) {
                sums.gloss[c] += part * (double)gloss.raw[c];
                sums.fit[c] += part * (double)fit.raw[c];
                sums.off[c] += part * fabs((double)(gloss.raw[c] - fit.raw[c]));
            }
        }
    }
    return sums;
}

/* White light from everywhere: surface and threads together send back no more than arrives. Towards a viewer
 * above the cloth facets turn little, and Schlick's term is that of the normal: threads lose what the surface
 * sends. */
static void test_furnace(void **state)
{
    (void)state;
    double largest = 0;
    for (int systems = 1; systems <= 2; systems++) {
        const tl_material material = cloth_of(systems);
        const struct tl_brdf_sum sum = sum_of(&material);
        for (size_t p = 0; p < TL_COUNT(polars); p++)
            for (size_t a = 0; a < TL_COUNT(azimuths); a++) {
                const vec3s v = from_angles(polars[p], azimuths[a]);
                double sent[3] = {0};
                for (int i = 0; i < sum.count; i++) {
                    struct sums sums = integrate(&sum.items[i], v, NULL, 0);
                    for (int c = 0; c < 3; c++)
                        sent[c] += sums.gloss[c];
                    if (p > 0 || i == 0)
                        continue;
                    struct tl_brdf bare = sum.items[i];
                    bare.f0 = glms_vec3_zero();
                    assert_near(sums.gloss[1] / integrate(&bare, v, NULL, 0).gloss[1], 1 - 0.045, 1e-3);
                }
                for (int c = 0; c < 3; c++) {
                    assert_true(sent[c] <= 1);
                    largest = fmax(largest, sent[c]);
                }
            }
    }
    print_message("white cloth sends back %.3f at most\n", largest);
}

static void test_reciprocity(void **state)
{
    (void)state;
    for (int systems = 1; systems <= 2; systems++) {
        const tl_material material = cloth_of(systems);
        const struct tl_brdf_sum sum = sum_of(&material);
        for (size_t p = 0; p < TL_COUNT(polars); p++)
            for (size_t q = 0; q < TL_COUNT(polars); q++)
                for (size_t a = 0; a < TL_COUNT(azimuths); a++) {
                    vec3s l = from_angles(polars[p], 0.3f), v = from_angles(polars[q], azimuths[a] + 2);
                    vec3s there = glms_vec3_divs(tl_brdf_sum_gloss(&sum, &frame, l, v), l.z);
                    vec3s back = glms_vec3_divs(tl_brdf_sum_gloss(&sum, &frame, v, l), v.z);
                    for (int c = 0; c < 3; c++)
                        assert_near(there.raw[c], back.raw[c], 1e-4f * (there.raw[c] + back.raw[c]) + 1e-9f);
                }
    }
}

/* The colours: white where the surface reflects, at the mirror direction of a grazing viewer; the threads'
 * colours beside it, of warps and of wefts on their own sides. */
static void test_colours(void **state)
{
    (void)state;
    const tl_material silk = cloth_of(2);
    const struct tl_brdf_sum sum = sum_of(&silk);
    const vec3s v = from_angles(0.3f, 0.785f);
    /* Turned about the warp (along v, the y axis): across it the warps' band is broad. */
    vec3s across = tl_brdf_sum_gloss(&sum, &frame, tl_brdf_mirror(from_angles(0.5f, 0), v), v);
    vec3s along = tl_brdf_sum_gloss(&sum, &frame, tl_brdf_mirror(from_angles(0.5f, 1.571f), v), v);
    assert_true(across.x > 4 * across.z); /* red warps */
    assert_true(along.z > 4 * along.x);   /* blue wefts */
    vec3s grazing = from_angles(1.5f, 0.4f), mirror = tl_brdf_mirror(frame.normal, grazing);
    vec3s white = tl_brdf_sum_gloss(&sum, &frame, mirror, grazing);
    assert_near(white.x, white.z, 0.25 * (double)white.x);
    /* 1 - F by the surface's own F0, to the last digit */
    const struct tl_brdf *thread = &sum.items[1];
    assert_near(tl_brdf_fresnel(thread, 0.4f).x, 1 - schlick_reflectance(0.045f, schlick_share(0.4f)), 1e-6);
}

/* Unresolved bumps and yarns widen a thread's lobe as they do Ward's facets, along u and v apart. */
static void test_widening(void **state)
{
    (void)state;
    tl_material satin = cloth_of(1);
    const float wider[3] = {0, 0.05f, 0};
    struct tl_brdf_sum sum =
        tl_brdf_sum_of(&satin, satin.specular, satin.diffuse, satin.glossiness, 1, wider);
    assert_near(sum.items[1].gloss.width_weft, 0.45, 1e-6);
    assert_near(sum.items[1].gloss.width_warp, sqrt(0.124 * 0.124 + 0.05), 1e-6);
    satin.gloss.rotation = GLM_PI_2f; /* the warp lies along u */
    sum = tl_brdf_sum_of(&satin, satin.specular, satin.diffuse, satin.glossiness, 1, wider);
    assert_near(sum.items[1].gloss.width_weft, sqrt(0.45 * 0.45 + 0.05), 1e-6);
    assert_near(sum.items[1].gloss.width_warp, 0.124, 1e-6);
}

/* The lobes of a thread's lobe keeps its light, and how much of it goes elsewhere: measured with 7 lobes,
 * rounded up. test_layered has the error of images. */
static void test_lobes_of_thread(void **state)
{
    (void)state;
    const tl_material satin = cloth_of(1);
    const struct tl_brdf_sum sum = sum_of(&satin);
    double off = 0;
    int views = 0;
    for (size_t p = 0; p < 4; p++)
        for (size_t a = 0; a < TL_COUNT(azimuths); a++, views++) {
            struct tl_fitted_lobe lobes[TL_LOBE_FIT_MAX];
            vec3s v = from_angles(polars[p], azimuths[a]);
            int count = tl_lobe_fit_make(&sum.items[1], &frame, v, 1, 7, lobes);
            struct sums sums = integrate(&sum.items[1], v, lobes, count);
            for (int c = 0; c < 2; c++)
                assert_near(sums.fit[c] / sums.gloss[c], 1, 0.06);
            assert_near(sums.fit[2], 0, 0);
            off += sums.off[0] / sums.gloss[0];
        }
    print_message("lobes of a thread: %.1f %% of its light off\n", 100 * off / views);
    assert_true(off / views < 0.35);
}

/* Facets and threads fitted at once, as lanes, and one by one. */
static void test_fit_of_sum(void **state)
{
    (void)state;
    for (int threads = 0; threads <= TL_THREADS_MAX; threads++)
        for (size_t p = 0; p < 4; p++)
            for (size_t a = 0; a < TL_COUNT(azimuths); a++) {
                const tl_material satin = cloth_of(threads);
                const struct tl_brdf_sum sum = sum_of(&satin);
                const vec3s v = from_angles(polars[p], azimuths[a]);
                struct tl_fitted_lobe at_once[TL_LOBE_FIT_SUM_MAX], lobes[TL_LOBE_FIT_MAX];
                int first = 0, count = tl_lobe_fit_sum(&sum, &frame, v, 5, at_once);
                for (int i = 0; i < sum.count; i++) {
                    const int own = tl_lobe_fit_make(&sum.items[i], &frame, v, 1, 5, lobes);
                    for (int k = 0; k < own; k++) {
                        if (!(glms_vec3_max(lobes[k].weight) > 0))
                            continue; /* nothing is reflected there */
                        assert_true(first < count);
                        const struct tl_fitted_lobe *lobe = &at_once[first++];
                        assert_near(lobe->exponent / lobes[k].exponent, 1, 1e-4);
                        for (int c = 0; c < 3; c++) {
                            assert_near(lobe->direction.raw[c], lobes[k].direction.raw[c], 1e-4);
                            assert_near(lobe->weight.raw[c], lobes[k].weight.raw[c], 1e-3);
                        }
                    }
                }
                assert_int_equal(first, count);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_furnace),         cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_colours),         cmocka_unit_test(test_widening),
        cmocka_unit_test(test_lobes_of_thread), cmocka_unit_test(test_fit_of_sum)};
    return cmocka_run_group_tests_name("threads", tests, NULL, NULL);
}
