/* Moving light: a renderer that has followed a sequence of environments draws what a new
 * renderer draws that knows that frame only. No region, PEM or map is left over from an earlier one. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/pem/pems.h"

#include "tests/testing.h"

#include <string.h>

#define FRAMES 64

/* The frame for which `sky` is asked: an environment's radiance is a function of direction only. */
static int sky_frame;

/* A sun that rises and sets, a cloud that drifts, and a sky that turns from blue to red. */
static vec3s sky(vec3s d)
{
    float turn = (float)(sky_frame * 2 * M_PI / FRAMES);
    vec3s sun = {{cosf(turn), 0.3f + 0.6f * sinf(turn), 0.4f}};
    vec3s cloud = {{sinf(turn), 0.5f, -cosf(turn)}};
    float red = 0.5f + 0.4f * sinf(turn), blue = 0.5f + 0.4f * cosf(turn);
    float grey = glms_vec3_dot(d, glms_vec3_normalize(cloud)) > 0.9f ? 2 : 0;
    if (glms_vec3_dot(d, glms_vec3_normalize(sun)) > 0.985f)
        return (vec3s){{40, 35, 30}};
    return (vec3s){{red + grey, 0.4f + grey, blue + grey}};
}

static void scene_open(struct test_scene *scene)
{
    sky_frame = 0;
    test_scene_open_ball_and_sheet(scene, sky);
    scene->shapes[0].material.glossiness = 0.95f;
    scene->shapes[1].material.glossiness = 0.3f;
}

/* The next frame's environment in the place of the last, as a session does it; every fourth frame the shapes
 * move too, every seventh the environment is turned. */
static void scene_step(struct test_scene *scene, int number)
{
    sky_frame = number;
    tl_environment_release(&scene->environment);
    scene->environment = test_environment(64, 32, sky);
    scene->frame.environment_revision++;
    if (number % 4 == 0) {
        for (size_t i = 0; i < scene->shapes[1].mesh.vertex_count; i++)
            scene->shapes[1].mesh.positions[i].y += 0.002f;
        scene->surfaces[1].motion_revision++;
    }
    if (number % 7 == 0)
        scene->frame.environment_yaw += 0.3f;
}

static void expect_fresh(struct test_device *device, tl_renderer *renderer, const struct test_scene *scene,
                         int number)
{
    tl_error error = {0};
    tl_image followed = test_scene_draw(scene, renderer);
    tl_renderer *fresh = tl_renderer_create(device->gpu, &error);
    assert_non_null(fresh);
    tl_image rebuilt = test_scene_draw(scene, fresh);
    size_t bytes = (size_t)followed.width * (size_t)followed.height * 4 * sizeof(float);
    if (memcmp(followed.texels, rebuilt.texels, bytes) != 0)
        print_error("frame %d differs from that of a new renderer\n", number);
    assert_memory_equal(followed.texels, rebuilt.texels, bytes);
    tl_renderer_destroy(&fresh);
    tl_image_release(&followed);
    tl_image_release(&rebuilt);
}

/* The image must also change from frame to frame, or the test would see nothing. A new renderer takes a
 * while: it is asked `every` so many frames, and at the end. */
static void play(struct test_device *device, const struct tl_light_params *light, int every)
{
    tl_error error = {0};
    struct test_scene scene;
    scene_open(&scene);
    scene.settings.light = *light;
    tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
    assert_non_null(renderer);
    tl_image before = test_scene_draw(&scene, renderer);
    for (int number = 1; number < FRAMES; number++) {
        scene_step(&scene, number);
        if (number % every == 0 || number == FRAMES - 1)
            expect_fresh(device, renderer, &scene, number);
        tl_image now = test_scene_draw(&scene, renderer);
        size_t bytes = (size_t)now.width * (size_t)now.height * 4 * sizeof(float);
        assert_memory_not_equal(now.texels, before.texels, bytes);
        tl_image_release(&before);
        before = now;
    }
    tl_image_release(&before);
    tl_renderer_destroy(&renderer);
    test_scene_close(&scene);
}

static struct tl_light_params small_light(void)
{
    struct tl_light_params light = test_settings(1, 1).light;
    light.map_size = 32;
    light.pem_size = 16;
    return light;
}

/* The sum of all PEMs. */
static void pems_follow(void **state)
{
    struct tl_light_params light = small_light();
    light.method = TL_METHOD_UNSHADOWED;
    play(*state, &light, 4);
    light.pem_layout = TL_PEM_PARABOLOID;
    play(*state, &light, 4);
}

/* All PEMs, each with its own shadow. */
static void shadows_follow(void **state)
{
    struct tl_light_params light = small_light();
    light.lobe = TL_LOBE_SINGLE;
    play(*state, &light, 8);
}

/* Suns with maps of their own, which come and go with the sky, regions of the sphere, the ratio. */
static void suns_follow(void **state)
{
    struct tl_light_params light = small_light();
    light.cut = TL_CUT_SPHERE;
    light.sun = true;
    light.pem_size = 32;
    light.visibility = TL_VISIBILITY_DEPTH;
    light.composition = TL_COMPOSE_RATIO;
    play(*state, &light, 8);
}

static double distance(const tl_image *a, const tl_image *b)
{
    double sum = 0;
    for (size_t i = 0; i < 4 * (size_t)a->width * (size_t)a->height; i++) {
        double difference = (double)tl_image_floats(a)[i] - (double)tl_image_floats(b)[i];
        sum += difference * difference;
    }
    return sqrt(sum);
}

/* The image by a new renderer. */
static tl_image draw_new(struct test_device *device, const struct test_scene *scene)
{
    tl_error error = {0};
    tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
    assert_non_null(renderer);
    tl_image image = test_scene_draw(scene, renderer);
    tl_renderer_destroy(&renderer);
    return image;
}

/* Rays, all of which are traced in every frame, in the same directions: what was followed is what a new
 * renderer draws. Eight frames at a time turn the sun by 45 degrees, which would be seen. */
static void rays_follow(void **state)
{
    struct test_device *device = *state;
    tl_error error = {0};
    struct test_scene scene;
    scene_open(&scene);
    scene.settings.light = small_light();
    scene.settings.light.cut = TL_CUT_SPHERE;
    scene.settings.light.sun = true;
    scene.settings.light.regions = 96;
    scene.settings.light.pem_size = 32;
    scene.settings.light.visibility = TL_VISIBILITY_RAYS;
    scene.settings.light.composition = TL_COMPOSE_RATIO;
    scene.settings.light.refresh = 0;
    tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
    assert_non_null(renderer);
    tl_image before = test_scene_draw(&scene, renderer);
    double stale = 0, change = 0;
    for (int number = 8; number < FRAMES; number += 8) {
        scene_step(&scene, number);
        tl_image followed = test_scene_draw(&scene, renderer);
        tl_image rebuilt = draw_new(device, &scene);
        stale += distance(&followed, &rebuilt);
        change += distance(&before, &rebuilt);
        tl_image_release(&rebuilt);
        tl_image_release(&before);
        before = followed;
    }
    printf("rays: off by %.4f of the change\n", stale / change);
    assert_true(stale < 1e-3 * change);
    tl_image_release(&before);
    tl_renderer_destroy(&renderer);
    test_scene_close(&scene);
}

/* The environment as it is seen behind belongs to the frame too. */
static void the_background_follows(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    tl_error error = {0};
    scene_open(&scene);
    scene.frame.surface_count = 0;
    scene.settings.image.ground = false;
    scene.settings.light = small_light();
    scene.settings.light.method = TL_METHOD_UNSHADOWED;
    scene.settings.image.background = TL_BACKGROUND_BLURRED;
    tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
    for (int number = 1; number < 8; number++) {
        scene_step(&scene, number * 8);
        tl_image shown[2];
        for (int i = 0; i < 2; i++) {
            tl_renderer *drawn = i == 0 ? renderer : tl_renderer_create(device->gpu, &error);
            assert_ok(tl_renderer_draw(drawn, &scene.frame, &scene.settings, &error), error);
            assert_ok(tl_renderer_show_image(drawn, &shown[i], &error), error);
            if (i == 1)
                tl_renderer_destroy(&drawn);
        }
        assert_memory_equal(shown[0].texels, shown[1].texels, (size_t)48 * 32 * 3);
        tl_image_release(&shown[0]);
        tl_image_release(&shown[1]);
    }
    tl_renderer_destroy(&renderer);
    test_scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pems_follow),
        cmocka_unit_test(shadows_follow),
        cmocka_unit_test(suns_follow),
        cmocka_unit_test(rays_follow),
        cmocka_unit_test(the_background_follows),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
