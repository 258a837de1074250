/* A weave that is seen from afar: its mean shade against that of the same view with samples
 * finer than its texels, octave by octave; and how much it shimmers while the camera backs away. */
#include "tests/render/scenes.h"

#include "assets/environment/studio.h"
#include "assets/weave/weave.h"
#include "config/base/memory.h"

#include "tests/testing.h"

#include <string.h>

/* Pixels. The truth has two samples a texel where the ball faces the viewer; in the others a pixel is as
 * large as 2, 4
 * ... 32 texels there, for yarns so much finer. */
#define TRUTH_SIZE 320
#define SIZE       80
#define YARNS      30 /* of the truth, about the equator */
#define OCTAVES    5

static tl_weave weave_of(int pattern, int yarns, float uv_metres)
{
    static const int repeats[] = {[TL_WEAVE_PLAIN] = 2, [TL_WEAVE_TWILL] = 4, [TL_WEAVE_SATIN] = 5};
    int whole_repeats = yarns / repeats[pattern];
    float pitch_mm = 1e3f * uv_metres / (float)(whole_repeats * repeats[pattern]);
    const struct tl_weave_params params = {.pattern = pattern,
                                           .warp_pitch_mm = pitch_mm,
                                           .weft_pitch_mm = pitch_mm,
                                           .crimp_mm = 0.35f * pitch_mm,
                                           .warp_gloss = 0.02f,
                                           .weft_gloss = -0.2f,
                                           .warp_tint = {1, 1, 1},
                                           .weft_tint = {0.8f, 0.8f, 0.8f},
                                           .texels_per_yarn = 16};
    tl_weave weave;
    assert_true(tl_weave_create(&params, &weave));
    return weave;
}

struct stage {
    tl_weave weave;
    struct test_shape shape;
};
static tl_environment studio;

/* A ball, so that all normals are seen; the weave is to scale about its equator. */
static struct stage *stage_new(int pattern, int yarns)
{
    struct stage *stage = TL_NEW(struct stage);
    stage->shape = test_sphere((vec3s){{0, 0, 0}}, 1, 128);
    tl_mesh *mesh = &stage->shape.mesh;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->uvs[i].y *= 0.5f;
    mesh->parts[0].uv_metres = 2 * (float)M_PI;
    stage->weave = weave_of(pattern, yarns, mesh->parts[0].uv_metres);
    tl_material *material = &stage->shape.material;
    material->diffuse = (vec3s){{0.3f, 0.022f, 0.045f}};
    material->specular = (vec3s){{0.12f, 0.1f, 0.1f}};
    material->glossiness = 0.94f;
    material->weave = &stage->weave;
    test_shape_refresh(&stage->shape);
    return stage;
}

static void stage_free(struct stage *stage)
{
    tl_weave_release(&stage->weave);
    test_shape_release(&stage->shape);
    free(stage);
}

static tl_image view(tl_renderer *renderer, const struct stage *stage, int size, int supersample, int minify)
{
    tl_frame frame =
        test_frame((vec3s){{6, 2, 9}}, (vec3s){{0, 0, 0}}, 10.8f, &stage->shape.surface, 1, &studio);
    struct tl_render_settings settings = test_settings(size, size);
    settings.light.method = TL_METHOD_PEM;
    settings.light.visibility = TL_VISIBILITY_RAYS;
    settings.light.composition = TL_COMPOSE_RATIO;
    settings.light.regions = 48;
    settings.light.cut = TL_CUT_SPHERE;
    settings.detail.minify = minify;
    settings.image.supersample = supersample;
    return test_draw(renderer, &frame, &settings);
}

/* Over fully covered pixels only, so that the steps of the edge do not count. */
static vec3s mean_of(const tl_image *image)
{
    double sums[4] = {0};
    for (int i = 0; i < image->width * image->height; i++)
        for (int c = 0; c < 4; c++)
            sums[c] += (double)tl_image_floats(image)[4 * i + c];
    return (vec3s){{(float)(sums[0] / sums[3]), (float)(sums[1] / sums[3]), (float)(sums[2] / sums[3])}};
}

/* The largest relative error of the mean colour over the channels. */
static double off(vec3s tested, vec3s truth)
{
    double worst = 0;
    for (int c = 0; c < 3; c++)
        worst = fmax(worst, fabs((double)(tested.raw[c] / truth.raw[c]) - 1));
    return worst;
}

static const char *const names[] = {"none", "toksvig", "lean"};

static double pixel_rmse(const tl_image *image, const tl_image *truth)
{
    int factor = truth->width / image->width;
    double squares = 0, mean = 0, count = 0;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            double sums[4] = {0};
            for (int i = 0; i < factor * factor; i++)
                for (int c = 0; c < 4; c++)
                    sums[c] +=
                        (double)test_pixel(truth, x * factor + i % factor, y * factor + i / factor)[c] /
                        (factor * factor);
            if (sums[3] < 1 || test_pixel(image, x, y)[3] < 1)
                continue;
            for (int c = 0; c < 3; c++) {
                squares += pow((double)test_pixel(image, x, y)[c] - sums[c], 2);
                mean += sums[c];
                count++;
            }
        }
    return sqrt(squares / count) / (mean / count);
}

/* The mean colour of every octave is within 2.5 % (2.2 % came out, part of it noise) of the exact one with
 * method rays, whose facets reflect nothing below the horizon of the surface. Once yarns are smaller than a
 * pixel, pixels are nearer to the exact values with minification than without. */
static void test_mean(void **state)
{
    struct test_device *device = *state;
    for (int pattern = TL_WEAVE_PLAIN; pattern <= TL_WEAVE_SATIN; pattern += 2) {
        struct stage *stage = stage_new(pattern, YARNS);
        tl_image truth = view(device->renderer, stage, TRUTH_SIZE, 2, 0);
        double rmse[3][OCTAVES], mean[3][OCTAVES];
        for (int minify = 0; minify < 3; minify++) {
            printf("%s, %-7s: mean and RMSE off by %%:", pattern == TL_WEAVE_PLAIN ? "plain" : "satin",
                   names[minify]);
            for (int octave = 0; octave < OCTAVES; octave++) {
                struct stage *far = stage_new(pattern, (YARNS / 2) << octave);
                tl_image image = view(device->renderer, far, SIZE, 1, minify);
                mean[minify][octave] = off(mean_of(&image), mean_of(&truth));
                rmse[minify][octave] = pixel_rmse(&image, &truth);
                printf("  %5.2f %5.2f", 100 * mean[minify][octave], 100 * rmse[minify][octave]);
                tl_image_release(&image);
                stage_free(far);
            }
            printf("\n");
        }
        for (int octave = 0; octave < OCTAVES; octave++) {
            assert_true(mean[TL_DETAIL_MINIFY_LEAN][octave] <= 0.025);
            assert_true(octave < 2 ||
                        rmse[TL_DETAIL_MINIFY_LEAN][octave] < rmse[TL_DETAIL_MINIFY_NONE][octave]);
        }
        tl_image_release(&truth);
        stage_free(stage);
    }
}

/* Root mean square change of a pixel from frame to frame, relative to the mean of the image, while the camera
 * moves away from a flat sheet that fills the image. Far away nothing should change. */
static double shimmer(tl_renderer *renderer, const struct stage *stage, int minify, float distance_m)
{
    enum { FRAMES = 8 };
    double squares = 0, mean = 0, count = 0;
    tl_image last = {0};
    for (int f = 0; f < FRAMES; f++) {
        float distance = distance_m * (1 + 0.003f * (float)f);
        tl_frame frame = test_frame((vec3s){{0.4f * distance, 0.2f * distance, 0.89f * distance}},
                                    (vec3s){{0, 0, 0}}, 4, &stage->shape.surface, 1, &studio);
        struct tl_render_settings settings = test_settings(SIZE, SIZE);
        settings.light.method = TL_METHOD_UNSHADOWED;
        settings.light.composition = TL_COMPOSE_DIFFERENCE;
        settings.detail.minify = minify;
        tl_image image = test_draw(renderer, &frame, &settings);
        for (int i = 0; f > 0 && i < SIZE * SIZE; i++)
            for (int c = 0; c < 3; c++, count++) {
                double now = (double)tl_image_floats(&image)[4 * i + c];
                squares += pow(now - (double)tl_image_floats(&last)[4 * i + c], 2);
                mean += now;
            }
        tl_image_release(&last);
        last = image;
    }
    tl_image_release(&last);
    return sqrt(squares / count) / (mean / count);
}

static void test_shimmer(void **state)
{
    struct test_device *device = *state;
    struct stage *stage = stage_new(TL_WEAVE_SATIN, YARNS);
    tl_material material = stage->shape.material;
    test_shape_release(&stage->shape);
    stage->shape = test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 0.5f, 4);
    stage->shape.material = material;
    tl_weave_release(&stage->weave);
    stage->weave = weave_of(TL_WEAVE_SATIN, 1000, 1);
    test_shape_refresh(&stage->shape);
    /* From yarns of four pixels to repeats of one; below two pixels a yarn is no longer a picture but noise.
     */
    for (int octave = 0; octave < 4; octave++) {
        float distance = ldexpf(0.28f, octave), texels = distance * 0.07f / SIZE * 16000;
        double changes[3];
        for (int minify = 0; minify < 3; minify++)
            changes[minify] = shimmer(device->renderer, stage, minify, distance);
        printf("%5.1f texels a pixel: shimmer none %.4f, toksvig %.4f, lean %.4f: %.1f times lower\n",
               (double)texels, changes[0], changes[1], changes[2], changes[0] / changes[2]);
        assert_true(changes[2] * (texels > 7 ? 4 : 1) < changes[0]);
    }
    stage_free(stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_mean), cmocka_unit_test(test_shimmer)};
    studio = tl_environment_studio();
    int failed = cmocka_run_group_tests(tests, test_device_open, test_device_close);
    tl_environment_release(&studio);
    return failed;
}
