/* Images that are shifted by parts of a pixel while nothing changes: their mean has smooth edges, whichever
 * way light is composed, and whatever changes ends it. Oracles: the algebra of a pinhole camera, and one
 * image of many samples a pixel. */
#include "config/base/memory.h"
#include "render/scene/view.h"
#include "tests/render/scenes.h"
#include "tests/testing.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 48, HEIGHT = 40, IMAGES_MAX = 1000 };

static void test_a_shift_moves_what_is_seen(void **state)
{
    (void)state;
    const struct tl_camera camera = {.eye = {{1, 2, 3}},
                                     .target = {{0.2f, 0.9f, 0}},
                                     .up = {{0, 1, 0}},
                                     .fov_y = 0.8f,
                                     .near_m = 0.1f,
                                     .far_m = 20};
    const struct tl_view view = tl_view_make(&camera, 3, 2), shifted = tl_view_shift(&view, 0.3f, -0.2f);
    const vec3s points[] = {{{0, 1, 0}}, {{0.5f, 0.2f, -1}}, {{-0.8f, 1.4f, 0.6f}}};
    for (size_t i = 0; i < TL_COUNT(points); i++) {
        const vec4s at = {{points[i].x, points[i].y, points[i].z, 1}};
        const vec4s before = glms_mat4_mulv(view.view_projection, at),
                    after = glms_mat4_mulv(shifted.view_projection, at);
        float x = after.x / after.w, y = after.y / after.w;
        assert_float_equal(x, before.x / before.w + 0.3f, 1e-5);
        assert_float_equal(y, before.y / before.w - 0.2f, 1e-5);
        assert_float_equal(after.z / after.w, before.z / before.w, 1e-6);
        /* The ray through that place leads to the point. */
        vec3s ray = glms_vec3_add(shifted.forward, glms_vec3_add(glms_vec3_scale(shifted.right, x),
                                                                 glms_vec3_scale(shifted.up, y)));
        vec3s to = glms_vec3_normalize(glms_vec3_sub(points[i], shifted.eye));
        assert_float_equal(glms_vec3_dot(glms_vec3_normalize(ray), to), 1, 1e-6);
    }
}

static void scene_open(struct test_scene *scene)
{
    test_scene_open(scene, test_environment(32, 16, test_white), (vec3s){{0, 0.3f, 2}}, (vec3s){{0}}, 40,
                    WIDTH, HEIGHT);
    test_scene_use_rays(scene, 8, 4);
    test_scene_add(scene, test_sphere((vec3s){{0}}, 0.45f, 48));
    test_scene_refresh(scene);
}

/* The largest error of a pixel's coverage. */
static double coverage_error(const tl_image *image, const tl_image *truth)
{
    double worst = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            worst = fmax(worst, fabs((double)(test_pixel(image, x, y)[3] - test_pixel(truth, x, y)[3])));
    return worst;
}

static tl_image many_samples(const struct test_device *device, struct test_scene *scene)
{
    tl_error error = {0};
    tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
    scene->settings.image.supersample = 8;
    tl_image image = test_draw(renderer, &scene->frame, &scene->settings);
    scene->settings.image.supersample = 1;
    tl_renderer_destroy(&renderer);
    return image;
}

/* The image at rest, and how many more than the first one were drawn for it. */
static tl_image rest(tl_renderer *renderer, const struct test_scene *scene, int *count)
{
    tl_image image = test_scene_draw(scene, renderer);
    for (*count = 0; !tl_renderer_is_at_rest(renderer); (*count)++) {
        assert_true(*count < IMAGES_MAX);
        tl_image_release(&image);
        image = test_scene_draw(scene, renderer);
    }
    assert_true(!scene->frame.smooth || *count >= TL_FRAME_SHIFTS - 1);
    return image;
}

/* Sixteen places in a pixel give its coverage by an edge within 0.16, its oracle within 0.05; its middle
 * alone within a half.
 */
static void expect_smooth_edges(const struct test_device *device, struct test_scene *scene)
{
    tl_error error = {0};
    tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
    int count;
    tl_image truth = many_samples(device, scene), plain = rest(renderer, scene, &count);
    assert_true(coverage_error(&plain, &truth) > 0.4);
    scene->frame.smooth = true;
    tl_image smooth = rest(renderer, scene, &count);
    printf("error of coverage %.3f\n", coverage_error(&smooth, &truth));
    assert_true(coverage_error(&smooth, &truth) < 3.5 / TL_FRAME_SHIFTS);
    /* Whatever changes, the next image is the plain one again. */
    scene->frame.camera.eye.y += 0.2f;
    scene->frame.camera.target.y += 0.2f;
    tl_image moved = test_scene_draw(scene, renderer), moved_truth = many_samples(device, scene);
    assert_true(coverage_error(&moved, &moved_truth) > 0.4);
    assert_true(coverage_error(&moved, &truth) > 0.9);
    assert_false(tl_renderer_is_at_rest(renderer));
    tl_image *images[] = {&truth, &plain, &smooth, &moved, &moved_truth};
    for (size_t i = 0; i < TL_COUNT(images); i++)
        tl_image_release(images[i]);
    tl_renderer_destroy(&renderer);
}

static void test_ratios_at_vertices(void **state)
{
    struct test_scene scene;
    scene_open(&scene);
    scene.settings.light.ratio_at = TL_RATIO_AT_VERTICES;
    expect_smooth_edges(*state, &scene);
    test_scene_close(&scene);
}

/* A shifted image sees a few vertices more or less. Each that was seen once has its rounds while the others
 * are seen, so that a rest takes not much longer than that of one image; else it would take sixteen times as
 * long. */
static void test_rounds_end(void **state)
{
    const struct test_device *device = *state;
    int counts[2];
    for (int smooth = 0; smooth < 2; smooth++) {
        tl_error error = {0};
        tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
        struct test_scene scene;
        scene_open(&scene);
        scene.settings.light.ratio_at = TL_RATIO_AT_VERTICES;
        scene.settings.light.refresh = 1;
        scene.settings.light.rounds = 8;
        scene.frame.smooth = smooth;
        tl_image image = rest(renderer, &scene, &counts[smooth]);
        print_message("%s: %d images\n", smooth ? "shifted" : "one place", counts[smooth]);
        tl_image_release(&image);
        test_scene_close(&scene);
        tl_renderer_destroy(&renderer);
    }
    assert_true(counts[1] <= counts[0] + 2 * TL_FRAME_SHIFTS);
}

static void test_light_at_samples(void **state)
{
    struct test_scene scene;
    scene_open(&scene);
    expect_smooth_edges(*state, &scene);
    test_scene_close(&scene);
}

/* Lamps keep the light on the GPU, where it is averaged by blending. */
static void test_lamps(void **state)
{
    struct test_scene scene;
    scene_open(&scene);
    scene.lamps[0] =
        (struct tl_lamp){.kind = TL_LAMP_DIRECTIONAL, .direction = {{0, 1, 1}}, .irradiance = {{1, 1, 1}}};
    scene.frame.lamps = scene.lamps;
    scene.frame.lamp_count = 1;
    expect_smooth_edges(*state, &scene);
    test_scene_close(&scene);
}

static void test_a_view_of_normals(void **state)
{
    struct test_scene scene;
    scene_open(&scene);
    scene.settings.image.view = TL_VIEW_NORMAL;
    expect_smooth_edges(*state, &scene);
    test_scene_close(&scene);
}

/* Passes average their rounds where the samples are, so that these must stay. */
static void test_passes_are_not_shifted(void **state)
{
    struct test_device *device = *state;
    tl_error error = {0};
    tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
    struct test_scene scene;
    test_scene_open_ball_and_sheet(&scene, test_daylight);
    tl_image plain = test_scene_draw(&scene, renderer);
    scene.frame.smooth = true;
    for (int i = 0; i < 3; i++) {
        tl_image again = test_scene_draw(&scene, renderer);
        assert_memory_equal(again.texels, plain.texels,
                            4 * sizeof(float) * (size_t)plain.width * (size_t)plain.height);
        tl_image_release(&again);
        assert_true(tl_renderer_is_at_rest(renderer));
    }
    tl_image_release(&plain);
    test_scene_close(&scene);
    tl_renderer_destroy(&renderer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_shift_moves_what_is_seen),
        cmocka_unit_test(test_ratios_at_vertices),
        cmocka_unit_test(test_light_at_samples),
        cmocka_unit_test(test_rounds_end),
        cmocka_unit_test(test_lamps),
        cmocka_unit_test(test_a_view_of_normals),
        cmocka_unit_test(test_passes_are_not_shifted),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
