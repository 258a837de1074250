/* Pictures of ratios at vertices against pictures of ratios at every sample, as drawn by the renderer: the
 * same cover, nearly the same light, whatever the material, the side, the turn of the light, the resolution;
 * the same bits at any number of threads, and the same bits as without where the scene needs samples. */
#include "tests/render/drawn_scene.h"

#include "render/metrics/compare.h"
#include "render/present/resample.h"

#include "tests/testing.h"

#include "config/base/memory.h"

#include <omp.h>
#include <string.h>

#define WIDTH        450
#define HEIGHT       400
#define SMALL_WIDTH  72
#define SMALL_HEIGHT 64
static void be_torrance_sparrow(struct drawn_scene *drawn)
{
    be_glossy(drawn);
    drawn_scene_cloth(drawn)->gloss.model = TL_REFLECT_TORRANCE_SPARROW;
    drawn_scene_cloth(drawn)->gloss.facets = TL_FACETS_BECKMANN;
}

static void be_holed(struct drawn_scene *drawn)
{
    drawn_scene_cloth(drawn)->diffuse_map = drawn_scene_map(&drawn->maps[MAP_HOLES]);
    drawn_scene_cloth(drawn)->alpha_cutoff = 0.5f;
}

static void be_fuzzy_voile(struct drawn_scene *drawn)
{
    be_voile(drawn);
    drawn_scene_cloth(drawn)->fuzz = (struct tl_fuzz){{{0.7f, 0.7f, 0.7f}}, 0.6f, 0};
}

static void be_open_all(struct drawn_scene *drawn)
{
    be_voile(drawn);
    be_glossy(drawn);
    drawn->scene.shapes[0].material.openness = 0.5f;
}

static void be_half_as_fine_voile(struct drawn_scene *drawn)
{
    be_voile(drawn);
    drawn->scene.settings.image.scale = 0.5f;
}

static void be_mapped_and_turned(struct drawn_scene *drawn)
{
    be_mapped(drawn);
    drawn->scene.frame.environment_yaw = 1;
}

static void be_satin_and_turned(struct drawn_scene *drawn)
{
    be_satin(drawn);
    drawn->scene.frame.environment_yaw = 1;
}

static void be_mapped_from_below(struct drawn_scene *drawn)
{
    be_mapped(drawn);
    look_up(drawn);
}

static void be_satin_from_below(struct drawn_scene *drawn)
{
    be_satin(drawn);
    look_up(drawn);
}

static void be_voile_from_below(struct drawn_scene *drawn)
{
    be_voile(drawn);
    look_up(drawn);
}

static void be_half_as_fine(struct drawn_scene *drawn)
{
    be_mapped(drawn);
    drawn->scene.settings.image.scale = 0.5f;
}

static void be_lit(struct drawn_scene *drawn)
{
    be_satin(drawn);
    drawn->scene.lamps[0] = test_lamp_at((vec3s){{0.6f, 1.5f, 0.8f}}, 4);
    drawn->scene.frame.lamp_count = 1;
}

static tl_image draw(const struct test_device *device, struct drawn_scene *drawn, int ratio_at)
{
    tl_error error = {0};
    drawn->scene.settings.light.ratio_at = ratio_at;
    assert_ok(tl_renderer_forget_scene(device->renderer, &error), error);
    return test_scene_draw(&drawn->scene, device->renderer);
}

#define COVER_TOLERANCE 2e-3

struct picture_case {
    const char *name;
    editor *edit;
    double all, cloth, worst; /* FLIP, means: of covered pixels, of the shapes', of the worst 5 % of these */
    double cover;             /* largest difference */
};

/* Bounds: measured, and a third of it; they detect a fault. What is largest is the normal map, whose normals
 * lean by up to 17 degrees: the ratio at a vertex is that of the smooth normal. Of fewer samples what lies
 * behind sheer cloth has their resolution, and so has the cover there: it may be off by what the cloth lets
 * through. */
static const struct picture_case pictures[] = {
    {"matt", be_matt, 0.004, 0.0064, 0.0226, COVER_TOLERANCE},
    {"glossy", be_glossy, 0.0052, 0.0103, 0.0398, COVER_TOLERANCE},
    {"satin", be_satin, 0.0042, 0.0069, 0.0277, COVER_TOLERANCE},
    {"torrance-sparrow", be_torrance_sparrow, 0.0051, 0.0099, 0.0401, COVER_TOLERANCE},
    {"fuzz", be_fuzzy, 0.0052, 0.0103, 0.0398, COVER_TOLERANCE},
    {"woven satin", be_woven, 0.0042, 0.0069, 0.0282, COVER_TOLERANCE},
    {"streaks", be_streaked, 0.0042, 0.0069, 0.0282, COVER_TOLERANCE},
    {"maps", be_mapped, 0.0185, 0.0493, 0.2082, COVER_TOLERANCE},
    {"cut-outs", be_holed, 0.0082, 0.0106, 0.0898, COVER_TOLERANCE},
    {"maps, light turned", be_mapped_and_turned, 0.0179, 0.048, 0.1996, COVER_TOLERANCE},
    {"satin, light turned", be_satin_and_turned, 0.0038, 0.006, 0.0234, COVER_TOLERANCE},
    {"maps from below", be_mapped_from_below, 0.0755, 0.0755, 0.2767, COVER_TOLERANCE},
    {"satin from below", be_satin_from_below, 0.0116, 0.0116, 0.0569, COVER_TOLERANCE},
    {"maps, scale 0.5", be_half_as_fine, 0.026, 0.069, 0.266, COVER_TOLERANCE},
    {"voile", be_voile, 0.0058, 0.009, 0.032, COVER_TOLERANCE},
    {"voile from below", be_voile_from_below, 0.0062, 0.0062, 0.0314, COVER_TOLERANCE},
    {"voile with fuzz", be_fuzzy_voile, 0.0058, 0.009, 0.032, COVER_TOLERANCE},
    {"open, all of it", be_open_all, 0.0068, 0.0107, 0.0374, COVER_TOLERANCE},
    {"satin, a near lamp", be_lit, 0.0042, 0.0069, 0.0277, COVER_TOLERANCE},
    {"voile, scale 0.5", be_half_as_fine_voile, 0.0088, 0.0155, 0.076, 0.411},
};

static void check_picture(const struct test_device *device, struct drawn_scene *drawn,
                          const struct picture_case *item)
{
    struct tl_comparison all;
    struct tl_object_error cloth;
    tl_error error = {0};
    drawn_scene_edit(drawn, item->edit);
    tl_image interpolated = draw(device, drawn, TL_RATIO_AT_VERTICES);
    drawn->scene.settings.image.scale = 1; /* fewer samples are compared with one a pixel */
    tl_image sampled = draw(device, drawn, TL_RATIO_AT_SAMPLES);
    tl_image mask = drawn_scene_mask(device, drawn);
    assert_ok(tl_image_compare(&interpolated, &sampled, 0, 0, &all, &error), error);
    assert_ok(tl_image_compare_object(&interpolated, &sampled, &mask, 0, &cloth, &error), error);
    double cover = drawn_scene_cover_difference(&interpolated, &sampled);
    printf("%-20s FLIP all %.4f, shapes %.4f, worst %.4f; rel. RMSE %.4f; cover %.1e\n", item->name,
           all.flip_mean, cloth.flip_mean, cloth.flip_worst, all.rel_rmse, cover);
    assert_true(memcmp(interpolated.texels, sampled.texels, 16 * (size_t)WIDTH * HEIGHT) != 0);
    assert_true(cloth.pixels > WIDTH * HEIGHT / 10);
    assert_near(cover, 0, item->cover);
    assert_near(all.flip_mean, 0, item->all);
    assert_near(cloth.flip_mean, 0, item->cloth);
    assert_near(cloth.flip_worst, 0, item->worst);
    tl_image_release(&mask);
    tl_image_release(&interpolated);
    tl_image_release(&sampled);
}

static void test_pictures(void **state)
{
    struct drawn_scene drawn;
    drawn_scene_open(&drawn, WIDTH, HEIGHT);
    for (size_t i = 0; i < TL_COUNT(pictures); i++)
        check_picture(*state, &drawn, &pictures[i]);
    drawn_scene_close(&drawn);
}

static void test_threads(void **state)
{
    struct drawn_scene drawn;
    drawn_scene_open(&drawn, WIDTH, HEIGHT);
    drawn_scene_edit(&drawn, be_woven);
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    tl_image alone = draw(*state, &drawn, TL_RATIO_AT_VERTICES);
    omp_set_num_threads(3);
    tl_image together = draw(*state, &drawn, TL_RATIO_AT_VERTICES);
    omp_set_num_threads(threads);
    assert_memory_equal(together.texels, alone.texels, 16 * (size_t)WIDTH * HEIGHT);
    tl_image_release(&alone);
    tl_image_release(&together);
    drawn_scene_close(&drawn);
}

/* ---- Scenes that need samples ---- */

static void have_nothing(struct drawn_scene *drawn)
{
    be_woven(drawn);
}

static void have_a_lamp(struct drawn_scene *drawn)
{
    drawn->scene.lamps[0] = test_lamp_towards((vec3s){{-0.5f, 1, 0.3f}}, 2);
    drawn->scene.frame.lamp_count = 1;
}

static void have_a_step(struct drawn_scene *drawn)
{
    have_a_lamp(drawn);
    drawn->scene.settings.shading.self_shadow = TL_SELF_SHADOW_STEP;
}

static void have_a_coat(struct drawn_scene *drawn)
{
    drawn_scene_cloth(drawn)->coat = 0.5f;
    drawn_scene_cloth(drawn)->coat_glossiness = 0.9f;
}

static void have_openness(struct drawn_scene *drawn)
{
    drawn_scene_cloth(drawn)->openness = 0.3f;
}

static void have_transmission(struct drawn_scene *drawn)
{
    drawn_scene_cloth(drawn)->transmission = (vec3s){{0.2f, 0.2f, 0.2f}};
}

static void have_a_mirror(struct drawn_scene *drawn)
{
    be_glossy(drawn);
    drawn_scene_cloth(drawn)->glossiness = 0.999f;
}

static void have_relief(struct drawn_scene *drawn)
{
    be_woven(drawn);
    drawn->scene.settings.detail.mode = TL_DETAIL_RELIEF;
}

static void have_parallax(struct drawn_scene *drawn)
{
    be_woven(drawn);
    drawn->scene.settings.detail.mode = TL_DETAIL_PARALLAX;
}

static void have_horizons(struct drawn_scene *drawn)
{
    be_woven(drawn);
    drawn->scene.settings.detail.shadow = TL_DETAIL_SHADOW_HORIZON;
}

static void have_a_height_map(struct drawn_scene *drawn)
{
    drawn_scene_cloth(drawn)->height_map = drawn_scene_map(&drawn->maps[MAP_GLOSS]);
    drawn_scene_cloth(drawn)->height_m = 0.002f;
}

static void have_aovs(struct drawn_scene *drawn)
{
    drawn->scene.frame.aovs = true;
}

static void have_occlusion_only(struct drawn_scene *drawn)
{
    drawn->scene.settings.light.method = TL_METHOD_AO;
}

static void have_regions_as_lights(struct drawn_scene *drawn)
{
    drawn->scene.settings.light.method = TL_METHOD_LIGHTS;
}

static void have_no_shadow(struct drawn_scene *drawn)
{
    drawn->scene.settings.light.method = TL_METHOD_UNSHADOWED;
}

static void have_one_lobe(struct drawn_scene *drawn)
{
    drawn->scene.settings.light.lobe = TL_LOBE_SINGLE;
}

static void have_a_view(struct drawn_scene *drawn)
{
    drawn->scene.settings.image.view = TL_VIEW_VISIBILITY;
}

static const struct {
    const char *name;
    editor *edit;
    bool needs_samples;
} needs[] = {
    {"nothing", have_nothing, false},
    {"matt", be_matt, false},
    {"a lamp", have_a_lamp, false},
    {"a lamp, shaded otherwise", have_a_step, true},
    {"a coat", have_a_coat, true},
    {"openness", have_openness, false},
    {"transmission", have_transmission, false},
    {"a mirror", have_a_mirror, true},
    {"relief", have_relief, true},
    {"parallax", have_parallax, true},
    {"horizon shadows", have_horizons, true},
    {"a height map", have_a_height_map, true},
    {"aovs", have_aovs, true},
    {"method ao", have_occlusion_only, true},
    {"method lights", have_regions_as_lights, true},
    {"method unshadowed", have_no_shadow, true},
    {"one lobe", have_one_lobe, true},
    {"a view", have_a_view, true},
};

static void test_scenes_that_need_samples(void **state)
{
    struct drawn_scene drawn;
    drawn_scene_open(&drawn, SMALL_WIDTH, SMALL_HEIGHT);
    drawn.plain.settings.light.rounds = 1;
    for (size_t i = 0; i < TL_COUNT(needs); i++) {
        drawn_scene_edit(&drawn, needs[i].edit);
        tl_image sampled = draw(*state, &drawn, TL_RATIO_AT_SAMPLES);
        tl_image wanted = draw(*state, &drawn, TL_RATIO_AT_VERTICES);
        bool same = memcmp(sampled.texels, wanted.texels, 16 * (size_t)SMALL_WIDTH * SMALL_HEIGHT) == 0;
        if (same != needs[i].needs_samples)
            print_error("%s: the images are %s\n", needs[i].name, same ? "the same" : "not the same");
        assert_int_equal(same, needs[i].needs_samples);
        tl_image_release(&sampled);
        tl_image_release(&wanted);
    }
    drawn_scene_close(&drawn);
}

/* ---- Between motion and rest ---- */

/* How a job of the last frame came out. */
static enum tl_job_action action_of(const struct test_device *device, const char *job)
{
    const tl_plan *plan = tl_renderer_last_plan(device->renderer);
    for (int i = 0; i < plan->count; i++)
        if (strcmp(plan->rows[i].name, job) == 0)
            return plan->rows[i].action;
    fail_msg("no job %s", job);
    return TL_JOB_DROP;
}

/* Bytes of a resource; 0: it holds nothing. */
static size_t bytes_of(const struct test_device *device, const char *name)
{
    struct tl_resource_memory rows[TL_RESOURCES_MAX];
    size_t count = tl_renderer_resources(device->renderer, rows);
    for (size_t i = 0; i < count; i++)
        if (strcmp(rows[i].name, name) == 0)
            return rows[i].bytes;
    return 0;
}

/* What samples need is still there after frames of ratios at vertices: maps, programs and targets. */
static void test_samples_after_ratios(void **state)
{
    const struct test_device *device = *state;
    struct drawn_scene drawn;
    drawn_scene_open(&drawn, SMALL_WIDTH, SMALL_HEIGHT);
    drawn.plain.settings.light.rounds = 1;
    drawn_scene_edit(&drawn, be_woven);
    drawn_scene_cloth(&drawn)->openness = 0.4f;
    test_scene_refresh(&drawn.scene);
    struct tl_render_settings *settings = &drawn.scene.settings;
    settings->detail.shadow = TL_DETAIL_SHADOW_NONE;
    tl_image first = draw(device, &drawn, TL_RATIO_AT_SAMPLES);
    const size_t detail = bytes_of(device, "detail maps"),
                 layers = bytes_of(device, "what is seen through cloth");
    assert_true(detail > 0 && layers > 0);
    assert_int_equal(action_of(device, "detail"), TL_JOB_RUN);
    settings->light.ratio_at = TL_RATIO_AT_VERTICES;
    tl_image second = test_scene_draw(&drawn.scene, device->renderer);
    assert_int_equal(bytes_of(device, "detail maps"), detail);
    assert_int_equal(bytes_of(device, "what is seen through cloth"), layers);
    settings->light.ratio_at = TL_RATIO_AT_SAMPLES;
    tl_image third = test_scene_draw(&drawn.scene, device->renderer);
    assert_int_equal(action_of(device, "detail"), TL_JOB_REUSE);
    assert_int_equal(action_of(device, "points"), TL_JOB_RUN); /* the last ones were for triangles */
    assert_near(drawn_scene_cover_difference(&first, &third), 0, 0);
    tl_image_release(&first);
    tl_image_release(&second);
    tl_image_release(&third);
    drawn_scene_close(&drawn);
}

/* ---- Fewer samples ---- */

/* FLIP of the shapes' pixels against one sample a pixel. `image` is released. */
static struct tl_object_error error_of(tl_image image, const tl_image *full, const tl_image *mask)
{
    struct tl_object_error result;
    tl_error error = {0};
    assert_ok(tl_image_compare_object(&image, full, mask, 0, &result, &error), error);
    tl_image_release(&image);
    return result;
}

/* The same samples resampled alike everywhere: a picture as large as they are many. */
static tl_image blurred(const struct test_device *device, struct drawn_scene *drawn)
{
    struct tl_image_params *image = &drawn->scene.settings.image;
    tl_image result = tl_image_create(WIDTH, HEIGHT, 4, TL_IMAGE_F32);
    tl_image_samples(image, &image->width, &image->height);
    image->scale = 1;
    tl_image samples = draw(device, drawn, TL_RATIO_AT_VERTICES);
    const struct tl_resample resample = {tl_image_floats(&samples), image->width, image->height,
                                         tl_image_floats(&result),  WIDTH,        HEIGHT};
    tl_resample(&resample);
    image->width = WIDTH;
    image->height = HEIGHT;
    tl_image_release(&samples);
    return result;
}

/* Pixels of fewer samples have the cover of one sample a pixel, and are nearer to it than the samples
 * resampled, all in all and where they are worst. */
static void check_scale(const struct test_device *device, struct drawn_scene *drawn, const tl_image *full,
                        const tl_image *mask, float scale)
{
    drawn->scene.settings.image.scale = scale;
    tl_image image = draw(device, drawn, TL_RATIO_AT_VERTICES);
    double cover = drawn_scene_cover_difference(&image, full);
    struct tl_object_error guided = error_of(image, full, mask);
    struct tl_object_error plain = error_of(blurred(device, drawn), full, mask);
    printf("  scale %.3f: FLIP shapes %.4f, worst %.4f; without outlines %.4f, %.4f; cover %.1e\n",
           (double)scale, guided.flip_mean, guided.flip_worst, plain.flip_mean, plain.flip_worst, cover);
    assert_near(cover, 0, COVER_TOLERANCE);
    assert_true(guided.flip_mean > 0 && guided.flip_mean < plain.flip_mean);
    assert_true(guided.flip_worst < 0.75 * plain.flip_worst);
}

static void test_fewer_samples(void **state)
{
    static editor *const editors[] = {be_matt, be_satin, be_satin_from_below};
    struct drawn_scene drawn;
    drawn_scene_open(&drawn, WIDTH, HEIGHT);
    for (size_t i = 0; i < TL_COUNT(editors); i++) {
        drawn_scene_edit(&drawn, editors[i]);
        tl_image full = draw(*state, &drawn, TL_RATIO_AT_VERTICES), mask = drawn_scene_mask(*state, &drawn);
        check_scale(*state, &drawn, &full, &mask, 0.841f);
        check_scale(*state, &drawn, &full, &mask, 0.5f);
        tl_image_release(&mask);
        tl_image_release(&full);
    }
    drawn_scene_close(&drawn);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures), cmocka_unit_test(test_threads), cmocka_unit_test(test_fewer_samples),
        cmocka_unit_test(test_samples_after_ratios), cmocka_unit_test(test_scenes_that_need_samples)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
