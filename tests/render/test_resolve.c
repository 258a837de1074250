/* The two ways from samples to pixels, as they are used: on the CPU, where the light was composed, and on the
 * GPU, where lamps were added to it. A lamp that is too weak to change a float's digits sends the same light
 * the other way. */
#include "render/renderer_internal.h"
#include "tests/render/scenes.h"
#include "tests/testing.h"

/* A ball behind an open sheet, so that there is coverage that is looked through. */
static void open_scene(struct test_scene *scene)
{
    test_scene_open_ball_and_sheet(scene, test_daylight);
    scene->shapes[1].material.openness = 0.4f;
    test_scene_refresh(scene);
    scene->settings.image.width = 90;
    scene->settings.image.height = 71;
    scene->settings.image.ground = true;
    scene->settings.light.visibility = TL_VISIBILITY_RAYS;
    scene->settings.light.composition = TL_COMPOSE_RATIO;
    scene->settings.light.regions = 8;
}

static void expect_same(tl_renderer *renderer, struct test_scene *scene, double tolerance)
{
    const double lamp = 1e-29; /* where it is dark */
    scene->frame.lamp_count = 0;
    tl_image on_cpu = test_scene_draw(scene, renderer);
    assert_true(renderer->resources.light.is_finished);
    scene->lamps[0] = test_lamp_towards((vec3s){{0, 1, 0}}, 1e-30f);
    scene->frame.lamp_count = 1;
    tl_image on_gpu = test_scene_draw(scene, renderer);
    assert_false(renderer->resources.light.is_finished);
    size_t count = 4 * (size_t)on_cpu.width * (size_t)on_cpu.height, different = 0, half_open = 0;
    for (size_t i = 0; i < count; i++) {
        float a = tl_image_floats(&on_cpu)[i], b = tl_image_floats(&on_gpu)[i];
        assert_near(a, b, tolerance * (double)b + lamp);
        different += fabsf(a - b) > (float)lamp;
        half_open += i % 4 == 3 && a > 0 && a < 1;
    }
    print_message("supersample %d, scale %.2g: %zu of %zu floats differ\n", scene->settings.image.supersample,
                  (double)scene->settings.image.scale, different, count);
    assert_true(half_open > 50);
    tl_image_release(&on_cpu);
    tl_image_release(&on_gpu);
}

/* One and four samples a pixel: the same sums, divided by a power of two. */
static void test_powers_of_two(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_scene(&scene);
    expect_same(device->renderer, &scene, 0);
    scene.settings.image.supersample = 2;
    expect_same(device->renderer, &scene, 0);
    test_scene_close(&scene);
}

/* Nine samples: GL may round a division otherwise. Fewer and more than one: resampled on both sides. */
static void test_other_sizes(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_scene(&scene);
    scene.settings.image.supersample = 3;
    expect_same(device->renderer, &scene, 3e-7);
    scene.settings.image.supersample = 1;
    scene.settings.image.scale = 0.7f;
    expect_same(device->renderer, &scene, 0);
    scene.settings.image.supersample = 2;
    scene.settings.image.scale = 0.8f;
    expect_same(device->renderer, &scene, 0);
    test_scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_powers_of_two),
        cmocka_unit_test(test_other_sizes),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
