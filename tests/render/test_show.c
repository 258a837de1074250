/* The two ways to show an image, as they are used: on the CPU, where the image was made there, and by
 * show.frag. The oracle of each is the other; both share the text of the tone mapper (present/tone.glsl),
 * whose own oracle is in present/test_tone_map.c. */
#include "assets/environment/studio.h"
#include "config/base/memory.h"
#include "render/env/convert.h"
#include "render/renderer_internal.h"
#include "tests/render/scenes.h"
#include "tests/testing.h"

#include <epoxy/gl.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Moves the renderer's image to the GPU, so that it is shown there. */
static void move_to_gpu(tl_renderer *renderer)
{
    struct tl_resources *resources = &renderer->resources;
    struct tl_linear_image *image = &resources->present.image;
    assert_non_null(image->texels);
    int width = image->width, height = image->height;
    float *texels = tl_alloc(image->bytes, 1);
    memcpy(texels, image->texels, image->bytes);
    tl_linear_image_begin_gpu(image, resources->gpu, width, height);
    glTextureSubImage2D(image->target.colours[0].id, 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, texels);
    resources->valid &= ~TL_BIT(TL_MADE_SHOWN);
    free(texels);
}

static tl_image show(tl_renderer *renderer)
{
    tl_error error = {0};
    tl_image shown;
    assert_ok(tl_renderer_show_image(renderer, &shown, &error), error);
    return shown;
}

/* Draws, shows on both sides and compares every byte. */
static void expect_same(tl_renderer *renderer, const struct test_scene *scene, const char *name)
{
    renderer->resources.valid &= ~TL_BIT(TL_MADE_IMAGE); /* the last one was moved */
    tl_image drawn = test_scene_draw(scene, renderer);
    tl_image_release(&drawn);
    tl_image on_cpu = show(renderer);
    move_to_gpu(renderer);
    tl_image by_shader = show(renderer);
    const uint8_t *a = tl_image_bytes(&on_cpu), *b = tl_image_bytes(&by_shader);
    size_t count = (size_t)on_cpu.width * (size_t)on_cpu.height * 3, different = 0, at = 0;
    int largest = 0;
    for (size_t i = 0; i < count; i++) {
        int difference = abs(a[i] - b[i]);
        different += difference > 0;
        if (difference > largest) {
            largest = difference;
            at = i / 3;
        }
    }
    print_message("%s, %d x %d: %.2f %% of the bytes differ, by %d at most\n", name, on_cpu.width,
                  on_cpu.height, 100.0 * (double)different / (double)count, largest);
    if (largest > 1)
        fail_msg("%s: pixel (%zu, %zu) is %d %d %d on the CPU and %d %d %d by the shader", name,
                 at % (size_t)on_cpu.width, at / (size_t)on_cpu.width, a[3 * at], a[3 * at + 1],
                 a[3 * at + 2], b[3 * at], b[3 * at + 1], b[3 * at + 2]);
    tl_image_release(&on_cpu);
    tl_image_release(&by_shader);
}

/* A ball and a sheet with a gloss that goes far beyond white, drawn by rays, in an image of this size. The
 * environment's yaw is not 0, so that a wrong turn is seen. */
static void open_scene(struct test_scene *scene, tl_environment environment, int width, int height)
{
    test_scene_open(scene, environment, (vec3s){{0.3f, 0.7f, 2.2f}}, (vec3s){{0, 0.35f, 0}}, 40, width,
                    height);
    test_scene_add(scene, test_sphere((vec3s){{0, 0.4f, 0}}, 0.4f, 32))->glossiness = 0.9f;
    test_scene_add(scene, test_sheet(0.8f, 0.5f, 0.05f, 9, 32));
    scene->frame.environment_yaw = 0.7f;
    scene->settings.light.visibility = TL_VISIBILITY_RAYS;
    scene->settings.light.composition = TL_COMPOSE_RATIO;
    scene->settings.light.regions = 8;
}

static void expect_same_backgrounds(tl_renderer *renderer, struct test_scene *scene, const char *where)
{
    static const char *const names[] = {"environment", "blurred", "grey"};
    for (int background = TL_BACKGROUND_ENVIRONMENT; background <= TL_BACKGROUND_GREY; background++) {
        char name[64];
        snprintf(name, sizeof name, "%s, %s", where, names[background]);
        scene->settings.image.background = background;
        expect_same(renderer, scene, name);
    }
}

static void test_backgrounds(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_scene(&scene, tl_environment_studio(), 900, 800);
    expect_same_backgrounds(device->renderer, &scene, "studio");
    scene.settings.image.exposure_ev = 2;
    scene.settings.image.width = 1920;
    scene.settings.image.height = 1080;
    scene.settings.light.pem_size = 128; /* as review has it: a sharper blur */
    expect_same_backgrounds(device->renderer, &scene, "studio, brighter");
    test_scene_close(&scene);
}

static uint8_t *shown_bytes(tl_renderer *renderer, const struct test_scene *scene, tl_image *shown)
{
    tl_image drawn = test_scene_draw(scene, renderer);
    tl_image_release(&drawn);
    renderer->resources.valid &= ~TL_BIT(TL_MADE_SHOWN);
    *shown = show(renderer);
    return tl_image_bytes(shown);
}

/* An environment's factors are those of an exposure, channel by channel, on figure and backdrop alike; light
 * that is twice as bright, with half the factors, is the same picture. */
static void test_adaptation(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_scene(&scene, tl_environment_studio(), 300, 200);
    scene.frame.environment_revision += 100; /* no studio has a revision of its own */
    tl_image plain, doubled, tinted;
    const uint8_t *a = shown_bytes(device->renderer, &scene, &plain);
    scene.environment.shown = (vec3s){{2, 2, 2}};
    scene.settings.image.exposure_ev = -1;
    const uint8_t *b = shown_bytes(device->renderer, &scene, &doubled);
    assert_memory_equal(a, b, (size_t)3 * 300 * 200);
    scene.settings.image.exposure_ev = 0;
    scene.settings.image.adapt = false;
    tl_image_release(&doubled);
    b = shown_bytes(device->renderer, &scene, &doubled);
    assert_memory_equal(a, b, (size_t)3 * 300 * 200);
    scene.settings.image.adapt = true;
    scene.environment.shown = (vec3s){{0.5f, 1, 0.25f}};
    b = shown_bytes(device->renderer, &scene, &tinted);
    size_t darker = 0, pixels = (size_t)300 * 200;
    for (size_t i = 0; i < pixels; i++) /* the tone mapper moves a channel by little where none is white */
        darker += b[3 * i] < a[3 * i] && b[3 * i + 2] < b[3 * i] && a[3 * i + 1] >= b[3 * i];
    assert_true(darker > pixels * 95 / 100);
    expect_same_backgrounds(device->renderer, &scene, "studio, tinted");
    tl_image_release(&plain);
    tl_image_release(&doubled);
    tl_image_release(&tinted);
    test_scene_close(&scene);
}

/* The mean of red of the lowest row's middle third: the ground before the figure. */
static double red_of_ground(struct test_device *device, const struct test_scene *scene)
{
    tl_image drawn = test_scene_draw(scene, device->renderer);
    const int width = drawn.width, from = width / 3, to = 2 * width / 3;
    double sum = 0;
    for (int x = from; x < to; x++)
        sum += (double)tl_image_floats(
            &drawn)[(size_t)drawn.channels * (size_t)((drawn.height - 1) * width + x)];
    tl_image_release(&drawn);
    return sum / (to - from);
}

/* The ground is of the colour that the environment's own has, from the frame in which the environment comes;
 * an option sets it by hand. */
static void test_ground_of_environment(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_scene(&scene, tl_environment_studio(), 120, 90);
    scene.settings.image.ground = true;
    scene.settings.light.method =
        TL_METHOD_UNSHADOWED; /* visibility has noise of its own, new in each frame */
    scene.frame.environment_revision += 200;
    double grey = red_of_ground(device, &scene);
    scene.environment.ground = (vec3s){{0.1f, 0.3f, 0.3f}};
    scene.frame.environment_revision++;
    assert_near(red_of_ground(device, &scene) / grey, 0.1 / 0.4, 1e-4);
    scene.settings.image.ground_grey = 0.8f;
    assert_near(red_of_ground(device, &scene) / grey, 0.8 / 0.4, 1e-3);
    test_scene_close(&scene);
}

/* The direction of a pixel, from the upper left corner. */
static vec3s direction_of(const struct test_scene *scene, int x, int y)
{
    const struct tl_image_params *image = &scene->settings.image;
    const struct tl_view view = tl_view_make(&scene->frame.camera, image->width, image->height);
    float across = 2 * ((float)x + 0.5f) / (float)image->width - 1,
          upwards = 1 - 2 * ((float)y + 0.5f) / (float)image->height;
    return glms_vec3_normalize(glms_vec3_add(
        view.forward, glms_vec3_add(glms_vec3_scale(view.right, across), glms_vec3_scale(view.up, upwards))));
}

/* Of the ground only its shadows are seen: where none falls, the disc, its fading rim and the backdrop below
 * the horizon are one colour, under a studio and under a sun. Light that a finite disc misses, or gets from
 * what stands on it, is below two bytes. Above -0.3 the coarse cube of these settings passes into the sky. */
static void expect_plain_ground(struct test_device *device, struct test_scene *scene, const char *name)
{
    const int width = scene->settings.image.width, height = scene->settings.image.height;
    const vec3s eye = scene->frame.camera.eye;
    tl_image shown;
    const uint8_t *bytes = shown_bytes(device->renderer, scene, &shown);
    int lowest[3] = {255, 255, 255}, highest[3] = {0}, count[2] = {0};
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const vec3s direction = direction_of(scene, x, y);
            if (direction.y > -0.3f)
                continue;
            const float distance = eye.y / -direction.y;
            const float from_middle = hypotf(eye.x + distance * direction.x, eye.z + distance * direction.z);
            if (from_middle < 0.25f || y < height / 8) /* the ball and its shadow */
                continue;
            count[from_middle < 0.5f]++;
            for (int c = 0; c < 3; c++) {
                const int byte = bytes[3 * (y * width + x) + c];
                lowest[c] = byte < lowest[c] ? byte : lowest[c];
                highest[c] = byte > highest[c] ? byte : highest[c];
            }
        }
    print_message("%s: %d pixels of the disc, %d beyond: %d..%d %d..%d %d..%d\n", name, count[1], count[0],
                  lowest[0], highest[0], lowest[1], highest[1], lowest[2], highest[2]);
    assert_true(count[0] > 1000 && count[1] > 1000);
    for (int c = 0; c < 3; c++)
        assert_true(highest[c] - lowest[c] <= 2);
    tl_image_release(&shown);
}

static void test_ground_melts_away(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    for (int sunny = 0; sunny < 2; sunny++) {
        tl_environment environment =
            sunny ? test_environment(256, 128, test_daylight) : tl_environment_studio();
        test_scene_open(&scene, environment, (vec3s){{0, 0.7f, 1.4f}}, (vec3s){{0, 0.1f, 0}}, 50, 300, 240);
        test_scene_add(&scene, test_sphere((vec3s){{0, 0.05f, 0}}, 0.05f, 16));
        scene.settings.light.visibility = TL_VISIBILITY_RAYS;
        scene.settings.light.composition = TL_COMPOSE_RATIO;
        scene.settings.image.background = TL_BACKGROUND_BLURRED;
        scene.settings.image.ground = true;
        scene.frame.environment_revision += 300 + (uint64_t)sunny;
        expect_plain_ground(device, &scene, sunny ? "daylight" : "studio");
        test_scene_close(&scene);
    }
}

/* An environment with a sun, as many texels as real ones have. */
static void test_large_environment(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_scene(&scene, test_environment(2048, 1024, test_daylight), 900, 800);
    scene.settings.light.pem_size = 128;
    expect_same_backgrounds(device->renderer, &scene, "daylight");
    scene.settings.image.width = 64; /* pixels as large as the texels of what is blurred */
    scene.settings.image.height = 48;
    expect_same_backgrounds(device->renderer, &scene, "daylight, small");
    scene.frame.camera.target.y = 3; /* towards the pole */
    scene.settings.image.width = 900;
    scene.settings.image.height = 800;
    expect_same_backgrounds(device->renderer, &scene, "daylight, upwards");
    test_scene_close(&scene);
}

/* The blurred studio is a room: no lamp is behind the figure, whichever way the camera looks. */
static void test_no_lamp_behind(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_scene(&scene, tl_environment_studio(), 96, 96);
    scene.settings.image.background = TL_BACKGROUND_BLURRED;
    scene.frame.environment_yaw = 0;
    for (int yaw = 0; yaw < 360; yaw += 30) {
        float azimuth = glm_rad((float)yaw);
        scene.frame.camera.target = (vec3s){{0, 3, 0}}; /* over the heads of ball and sheet */
        scene.frame.camera.eye = (vec3s){{sinf(azimuth), 3, cosf(azimuth)}};
        device->renderer->resources.valid &= ~TL_BIT(TL_MADE_IMAGE);
        tl_image drawn = test_scene_draw(&scene, device->renderer), shown = show(device->renderer);
        int brightest = 0;
        for (size_t i = 0; i < (size_t)3 * 96 * 96; i++)
            brightest = tl_image_bytes(&shown)[i] > brightest ? tl_image_bytes(&shown)[i] : brightest;
        print_message("from %d degrees the backdrop is %d of 255 at most\n", yaw, brightest);
        assert_in_range(brightest, 60, 170); /* a lamp is white */
        tl_image_release(&drawn);
        tl_image_release(&shown);
    }
    test_scene_close(&scene);
}

/* The studio as a cube. */
static tl_environment cube_studio(void)
{
    tl_environment studio = tl_environment_studio();
    const struct tl_sphere_map from = {TL_LAYOUT_LATLONG, studio.image.width, studio.image.height};
    const struct tl_sphere_map to = {TL_LAYOUT_CUBE, 128, 6 * 128};
    tl_image cube = tl_image_convert(&studio.image, &from, &to, NULL);
    tl_image_release(&studio.image);
    tl_image_release(&studio.backdrop);
    studio.image = cube;
    studio.layout = TL_ENV_CUBE;
    return studio;
}

static void test_cube(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_scene(&scene, cube_studio(), 900, 800);
    scene.settings.image.background = TL_BACKGROUND_ENVIRONMENT;
    expect_same(device->renderer, &scene, "cube");
    test_scene_close(&scene);
}

/* Views in place of light are neither exposed nor mapped. */
static void test_views(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_scene(&scene, tl_environment_studio(), 901, 333);
    scene.settings.image.exposure_ev = -3;
    for (int view = TL_VIEW_LIGHT + 1; view < TL_VIEW_STRAIN_WARP; view++) {
        scene.settings.image.view = view;
        expect_same(device->renderer, &scene, tl_image_view_names[view]);
    }
    test_scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_backgrounds),
        cmocka_unit_test(test_large_environment),
        cmocka_unit_test(test_no_lamp_behind),
        cmocka_unit_test(test_cube),
        cmocka_unit_test(test_views),
        cmocka_unit_test(test_adaptation),
        cmocka_unit_test(test_ground_of_environment),
        cmocka_unit_test(test_ground_melts_away),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
