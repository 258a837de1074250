/* Light made ready beside a renderer, and light that grows as materials ask for more of it: both give the
 * images that a new renderer gives, bit for bit. */
#include "config/base/memory.h"
#include "render/frame/light_cache.h"
#include "render/renderer.h"

#include "tests/render/scenes.h"

#include "tests/testing.h"

#include <math.h>
#include <string.h>

static vec3s evening(vec3s d)
{
    return (vec3s){{1.5f + d.x, 0.6f, 0.3f + 0.2f * d.y}};
}

struct scene {
    tl_environment environments[2];
    struct test_shape ball;
    tl_frame frame;
    struct tl_render_settings settings;
};

/* Method, visibility and cut of preset review, in small. */
static void scene_open(struct scene *scene)
{
    scene->environments[0] = test_environment(64, 32, test_daylight);
    scene->environments[1] = test_environment(64, 32, evening);
    scene->ball = test_sphere((vec3s){{0, 0.5f, 0}}, 0.4f, 24);
    test_shape_refresh(&scene->ball);
    scene->frame = test_frame((vec3s){{1, 1.5f, 2}}, (vec3s){{0, 0.6f, 0}}, 40, &scene->ball.surface, 1,
                              &scene->environments[0]);
    scene->settings = test_settings(48, 32);
    struct tl_light_params *light = &scene->settings.light;
    light->lobe = TL_LOBE_DUAL;
    light->cut = TL_CUT_SPHERE;
    light->visibility = TL_VISIBILITY_RAYS;
    light->composition = TL_COMPOSE_RATIO;
    light->sun = true;
    light->regions = 48;
    light->pem_size = 32;
    scene->settings.image.ground = true;
}

static void scene_close(struct scene *scene)
{
    tl_environment_release(&scene->environments[0]);
    tl_environment_release(&scene->environments[1]);
    test_shape_release(&scene->ball);
}

static void set_glossiness(struct scene *scene, float glossiness)
{
    scene->ball.material.glossiness = glossiness;
    scene->ball.material.specular = (vec3s){{0.3f, 0.3f, 0.3f}};
    scene->ball.surface.topology_revision++;
}

static void set_environment(struct scene *scene, int index)
{
    scene->frame.environment = &scene->environments[index];
    scene->frame.environment_revision++;
}

static tl_renderer *new_renderer(const struct test_device *device)
{
    tl_error error = {0};
    tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
    assert_non_null(renderer);
    return renderer;
}

/* `renderer`, whatever it drew before, against one that has drawn nothing. */
static void expect_as_new(const struct test_device *device, tl_renderer *renderer, const struct scene *scene)
{
    tl_renderer *fresh = new_renderer(device);
    tl_renderer_forget(renderer);
    tl_image a = test_draw(renderer, &scene->frame, &scene->settings);
    tl_image b = test_draw(fresh, &scene->frame, &scene->settings);
    assert_memory_equal(a.texels, b.texels, 16 * (size_t)a.width * (size_t)a.height);
    tl_image_release(&a);
    tl_image_release(&b);
    tl_renderer_destroy(&fresh);
}

static bool has_run(const tl_renderer *renderer, const char *job)
{
    const tl_plan *plan = tl_renderer_last_plan(renderer);
    for (int i = 0; i < plan->count; i++)
        if (strcmp(plan->rows[i].name, job) == 0)
            return plan->rows[i].action == TL_JOB_RUN;
    fail_msg("no job is called %s", job);
    return false;
}

static struct tl_prepared_request request_of(const struct scene *scene, int environment)
{
    return (struct tl_prepared_request){.environment = &scene->environments[environment],
                                        .settings = scene->settings,
                                        .region_counts = {scene->settings.light.regions, 24},
                                        .exponents = tl_prepared_exponents(&scene->frame, &scene->settings)};
}

static tl_prepared *prepare(const struct scene *scene, int environment)
{
    struct tl_prepared_request request = request_of(scene, environment);
    return tl_prepared_make(&request);
}

static void prepared_light_is_that_of_the_renderer(void **state)
{
    struct test_device *device = *state;
    tl_renderer *renderer = new_renderer(device);
    struct scene scene;
    scene_open(&scene);
    set_glossiness(&scene, 0.8f);
    tl_image first = test_draw(renderer, &scene.frame, &scene.settings);
    tl_image_release(&first);

    tl_prepared *prepared = prepare(&scene, 1);
    set_environment(&scene, 1);
    tl_renderer_take_prepared(renderer, &prepared, scene.frame.environment_revision);
    assert_null(prepared);
    expect_as_new(device, renderer, &scene);
    assert_true(has_run(renderer, "cube"));

    /* The other level's regions are there as well. */
    struct tl_render_settings coarse = scene.settings;
    coarse.light.regions = 24;
    assert_true(tl_renderer_has_regions(renderer, &coarse));
    coarse.light.regions = 12;
    assert_false(tl_renderer_has_regions(renderer, &coarse));
    scene.settings.light.regions = 24;
    expect_as_new(device, renderer, &scene);
    tl_renderer_destroy(&renderer);
    scene_close(&scene);
}

/* As for a second look beside the first. */
static void a_copy_serves_another_renderer(void **state)
{
    struct test_device *device = *state;
    tl_renderer *renderer = new_renderer(device), *other = new_renderer(device);
    struct scene scene;
    scene_open(&scene);
    set_glossiness(&scene, 0.8f);
    assert_null(tl_renderer_copy_prepared(renderer));
    expect_as_new(device, renderer, &scene);
    tl_prepared *copy = tl_renderer_copy_prepared(renderer);
    tl_renderer_take_prepared(other, &copy, scene.frame.environment_revision);
    expect_as_new(device, other, &scene);
    expect_as_new(device, renderer, &scene); /* which still has its own */
    tl_renderer_destroy(&renderer);
    tl_renderer_destroy(&other);
    scene_close(&scene);
}

/* Light prepared for another environment, or for other settings, is ignored. */
static void unfit_light_is_not_used(void **state)
{
    struct test_device *device = *state;
    tl_renderer *renderer = new_renderer(device);
    struct scene scene;
    scene_open(&scene);
    tl_prepared *prepared = prepare(&scene, 1);
    tl_renderer_take_prepared(renderer, &prepared, scene.frame.environment_revision + 1);
    expect_as_new(device, renderer, &scene);
    set_environment(&scene, 1);
    scene.settings.light.pem_size = 16;
    expect_as_new(device, renderer, &scene);
    tl_renderer_destroy(&renderer);
    scene_close(&scene);
}

static size_t bytes_of_lights(const tl_renderer *renderer)
{
    struct tl_resource_memory rows[TL_RESOURCES_MAX];
    for (size_t count = tl_renderer_resources(renderer, rows), i = 0; i < count; i++)
        if (strcmp(rows[i].name, "regions as lights") == 0)
            return rows[i].bytes;
    return 0;
}

/* Light that new materials need is added to the known light, none of which is computed again. */
static void known_light_is_added_to(void **state)
{
    struct test_device *device = *state;
    tl_renderer *renderer = new_renderer(device);
    struct scene scene;
    scene_open(&scene);
    set_glossiness(&scene, 0.2f);
    expect_as_new(device, renderer, &scene);
    set_glossiness(&scene, 0.9f);
    struct tl_render_settings coarse = scene.settings;
    coarse.light.regions = 24;
    assert_false(tl_renderer_has_regions(renderer, &coarse));
    struct tl_prepared_request request = request_of(&scene, 0);
    request.known = tl_renderer_copy_prepared(renderer);
    request.exponents |= tl_renderer_exponents(renderer);
    tl_prepared *prepared = tl_prepared_make(&request);
    assert_null(request.known);
    tl_renderer_take_prepared(renderer, &prepared, scene.frame.environment_revision);
    assert_null(prepared);
    assert_true(tl_renderer_has_regions(renderer, &coarse));
    size_t known = bytes_of_lights(renderer);
    assert_true(known > 0);
    tl_image image = test_draw(renderer, &scene.frame, &scene.settings);
    tl_image_release(&image);
    assert_false(has_run(renderer, "cube"));
    assert_true(has_run(renderer, "lights"));
    assert_int_equal(bytes_of_lights(renderer), known);
    expect_as_new(device, renderer, &scene);

    /* Only some of the known regions are needed, and some needed ones are not known. */
    for (int regions = 12; regions <= 36; regions += 12) {
        scene.settings.light.regions = regions;
        expect_as_new(device, renderer, &scene);
    }
    request.known = tl_renderer_copy_prepared(renderer);
    request.settings = scene.settings;
    request.region_counts[0] = 24;
    request.region_counts[1] = 60;
    prepared = tl_prepared_make(&request);
    tl_renderer_take_prepared(renderer, &prepared, scene.frame.environment_revision);
    for (int regions = 60; regions >= 24; regions -= 36) {
        scene.settings.light.regions = regions;
        assert_true(tl_renderer_has_regions(renderer, &scene.settings));
        expect_as_new(device, renderer, &scene);
    }

    /* Nothing is known of another cube. */
    request.known = tl_renderer_copy_prepared(renderer);
    request.settings.light.pem_size = scene.settings.light.pem_size = 16;
    prepared = tl_prepared_make(&request);
    tl_renderer_take_prepared(renderer, &prepared, scene.frame.environment_revision);
    expect_as_new(device, renderer, &scene);
    tl_renderer_destroy(&renderer);
    scene_close(&scene);
}

static void light_grows_with_the_materials(void **state)
{
    const float glossiness[] = {0.2f, 0.9f, 0.5f, 0.9f};
    struct test_device *device = *state;
    tl_renderer *renderer = new_renderer(device);
    struct scene scene;
    scene_open(&scene);
    for (int i = 0; i < 4; i++) {
        set_glossiness(&scene, glossiness[i]);
        expect_as_new(device, renderer, &scene);
    }
    /* Two looks at most are kept, however many there were. */
    size_t two = tl_renderer_memory(renderer).pems;
    for (int i = 0; i < 9; i++) {
        set_glossiness(&scene, 0.1f * (float)i);
        expect_as_new(device, renderer, &scene);
    }
    set_glossiness(&scene, 0.5f);
    expect_as_new(device, renderer, &scene);
    set_glossiness(&scene, 0.9f);
    expect_as_new(device, renderer, &scene);
    assert_true(tl_renderer_memory(renderer).pems <= two);
    tl_renderer_destroy(&renderer);
    scene_close(&scene);
}

/* Where nothing shines there is nothing to divide, to trace or to filter; one faint texel is light. */
static void black_environments_are_hardly_cut(void **state)
{
    (void)state;
    for (int cut = TL_CUT_FACES; cut <= TL_CUT_SPHERE; cut++) {
        tl_cube cube = tl_cube_create(8);
        struct tl_regions regions = {0};
        tl_light_cut_regions(&cube, 192, cut, &regions);
        assert_int_equal(regions.count, 6);
        cube.texels[3 * 8 * 8 + 1] = 1e-6f;
        tl_light_cut_regions(&cube, 192, cut, &regions);
        assert_int_equal(regions.count, 192);
        tl_regions_release(&regions);
        tl_cube_release(&cube);
    }
}

static vec3s faint(vec3s d)
{
    (void)d;
    return (vec3s){{1e-20f, 1e-20f, 1e-20f}};
}

static enum tl_job_action action_of(const tl_renderer *renderer, const char *job)
{
    const tl_plan *plan = tl_renderer_last_plan(renderer);
    for (int i = 0; i < plan->count; i++)
        if (strcmp(plan->rows[i].name, job) == 0)
            return plan->rows[i].action;
    fail_msg("no job %s", job);
    return TL_JOB_DROP;
}

/* A lamp in the dark, whose light bounces: what regions, lights and rays towards them would add to the
 * picture is shown by an environment so faint that its light is lost in the rounding of the lamp's. */
static void black_environments_trace_nothing(void **state)
{
    const struct test_device *device = *state;
    static const char *const dropped[] = {"regions", "lights", "points"};
    struct scene scene;
    scene_open(&scene);
    set_glossiness(&scene, 0.7f);
    const struct tl_lamp lamp = test_lamp_at((vec3s){{1, 2, 1}}, 3);
    scene.frame.lamps = &lamp;
    scene.frame.lamp_count = 1;
    scene.settings.light.bounce = TL_BOUNCE_ALL;
    tl_image images[2];
    for (int k = 0; k < 2; k++) {
        tl_environment_release(&scene.environments[k]);
        scene.environments[k] = test_environment(64, 32, k == 0 ? faint : test_black);
        set_environment(&scene, k);
        tl_renderer *renderer = new_renderer(device);
        images[k] = test_draw(renderer, &scene.frame, &scene.settings);
        for (size_t i = 0; i < TL_COUNT(dropped); i++)
            assert_int_equal(action_of(renderer, dropped[i]), k == 0 ? TL_JOB_RUN : TL_JOB_DROP);
        tl_renderer_destroy(&renderer);
    }
    size_t lit = 0;
    for (size_t i = 0; i < 4 * (size_t)images[0].width * (size_t)images[0].height; i++) {
        const float with = tl_image_floats(&images[0])[i], without = tl_image_floats(&images[1])[i];
        assert_true(fabsf(with - without) <= 1e-18f);
        lit += i % 4 < 3 && without > 0.01f;
    }
    assert_true(lit > 300);
    tl_image_release(&images[0]);
    tl_image_release(&images[1]);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(black_environments_are_hardly_cut),
        cmocka_unit_test(black_environments_trace_nothing),
        cmocka_unit_test(prepared_light_is_that_of_the_renderer),
        cmocka_unit_test(a_copy_serves_another_renderer),
        cmocka_unit_test(unfit_light_is_not_used),
        cmocka_unit_test(known_light_is_added_to),
        cmocka_unit_test(light_grows_with_the_materials),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
