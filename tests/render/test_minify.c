/* A weave that is seen from afar [TECHNIQUES C8]: its mean shade against that of the same view with samples finer than
 * its texels, octave by octave; and how much it shimmers while the camera backs away. */
#include "shapes.h"

#include "assets/studio.h"
#include "assets/weave.h"
#include "config/memory.h"

#include "testing.h"

#include <string.h>

/* Of the truth, in pixels: two samples a texel where the ball faces the viewer. */
#define TRUTH_SIZE 640
#define OCTAVES    5

static tl_weave weave_of(int pattern, float uv_metres)
{
    static const int repeats[] = {[TL_WEAVE_PLAIN] = 2, [TL_WEAVE_TWILL] = 4, [TL_WEAVE_SATIN] = 5};
    float pitch_mm = 1e3f * uv_metres / (float)(60 / repeats[pattern] * repeats[pattern]);
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
    tl_environment environment;
};

/* A ball, so that all normals are seen: about 60 yarns around its equator. */
static struct stage *stage_new(int pattern, bool glossy)
{
    struct stage *stage = TL_NEW(struct stage);
    stage->shape = test_sphere((vec3s){{0, 0, 0}}, 1, 128);
    stage->weave = weave_of(pattern, stage->shape.mesh.parts[0].uv_metres);
    stage->environment = tl_environment_studio();
    tl_material *material = &stage->shape.material;
    material->diffuse = glossy ? (vec3s){{0, 0, 0}} : (vec3s){{0.3f, 0.022f, 0.045f}};
    material->specular = glossy ? (vec3s){{1, 1, 1}} : (vec3s){{0.12f, 0.1f, 0.1f}};
    material->glossiness = 0.94f;
    material->weave = &stage->weave;
    test_shape_refresh(&stage->shape);
    return stage;
}

static void stage_free(struct stage *stage)
{
    tl_weave_release(&stage->weave);
    test_shape_release(&stage->shape);
    tl_environment_release(&stage->environment);
    free(stage);
}

static tl_image view(tl_renderer *renderer, const struct stage *stage, int size, int supersample, int minify)
{
    tl_frame frame = test_frame((vec3s){{6, 2, 9}}, (vec3s){{0, 0, 0}}, 10.8f, &stage->shape.surface, 1,
                                &stage->environment);
    struct tl_render_settings settings = test_settings(size, size);
    settings.light.method = TL_METHOD_PEM;
    settings.light.visibility = TL_VISIBILITY_RAYS;
    settings.light.composition = TL_COMPOSE_RATIO;
    settings.light.regions = 96;
    settings.light.cut = TL_CUT_SPHERE;
    settings.detail.minify = minify;
    settings.image.supersample = supersample;
    return test_draw(renderer, &frame, &settings);
}

/* Of what is covered, so that the edge's steps do not count. */
static vec3s mean_of(const tl_image *image)
{
    double sums[4] = {0};
    for (int i = 0; i < image->width * image->height; i++)
        for (int c = 0; c < 4; c++)
            sums[c] += (double)tl_image_floats(image)[4 * i + c];
    return (vec3s){{(float)(sums[0] / sums[3]), (float)(sums[1] / sums[3]), (float)(sums[2] / sums[3])}};
}

/* Of the mean colour, by channel. */
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
                    sums[c] += (double)test_pixel(truth, x * factor + i % factor, y * factor + i / factor)[c] / (factor * factor);
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

/* Every octave's mean colour within 2 % of the truth's; what it was without; and no pixel worse than without, in root
 * mean square. In method rays, which the reference agrees with: there facets send nothing below the surface's horizon. */
static void test_mean(void **state)
{
    struct test_device *device = *state;
    for (int pattern = TL_WEAVE_PLAIN; pattern <= TL_WEAVE_SATIN; pattern += 2) {
        struct stage *stage = stage_new(pattern, 0);
        tl_image truth = view(device->renderer, stage, TRUTH_SIZE, 2, 0);
        double rmse[3][OCTAVES], mean[3][OCTAVES];
        for (int minify = 0; minify < 3; minify++) {
            printf("%s, %-7s: mean and RMSE off by %%:", pattern == TL_WEAVE_PLAIN ? "plain" : "satin", names[minify]);
            for (int octave = 0; octave < OCTAVES; octave++) {
                tl_image image = view(device->renderer, stage, TRUTH_SIZE >> (octave + 1), 1, minify);
                mean[minify][octave] = off(mean_of(&image), mean_of(&truth));
                rmse[minify][octave] = pixel_rmse(&image, &truth);
                printf("  %5.2f %5.2f", 100 * mean[minify][octave], 100 * rmse[minify][octave]);
                tl_image_release(&image);
            }
            printf("\n");
        }
        for (int octave = 0; octave < OCTAVES; octave++) {
            assert_true(mean[TL_DETAIL_MINIFY_LEAN][octave] <= 0.02);
            assert_true(rmse[TL_DETAIL_MINIFY_LEAN][octave] < rmse[TL_DETAIL_MINIFY_NONE][octave]);
        }
        tl_image_release(&truth);
        stage_free(stage);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_mean)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
