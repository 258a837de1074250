/* The renderer as a whole: what runs again and what does not, memory, refusals, extremes. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/surfaces/ground.h"

#include "tests/testing.h"

#include <string.h>

/* One texel of 1e6 on test_black. */
static vec3s spark(vec3s d)
{
    return glms_vec3_dot(d, glms_vec3_normalize((vec3s){{1, 2, 1}})) > 0.9995f ? (vec3s){{1e6f, 1e6f, 1e6f}}
                                                                               : (vec3s){{0, 0, 0}};
}

static void scene_open(struct test_scene *scene, test_radiance *radiance)
{
    test_scene_open_ball_and_sheet(scene, radiance);
    for (int i = 0; i < 2; i++)
        scene->shapes[i].material.glossiness = 0.7f;
    scene->settings.light.map_size = 32;
}

static void draw(tl_renderer *renderer, const struct test_scene *scene)
{
    tl_error error = {0};
    assert_ok(tl_renderer_draw(renderer, &scene->frame, &scene->settings, &error), error);
}

/* The jobs that ran, as one string: "gbuffer light resolve". */
static const char *jobs_run(const tl_plan *plan)
{
    static char names[256];
    names[0] = '\0';
    for (int i = 0; i < plan->count; i++)
        if (plan->rows[i].action == TL_JOB_RUN) {
            size_t length = strlen(names);
            snprintf(names + length, sizeof names - length, "%s%s", length ? " " : "", plan->rows[i].name);
        }
    return names;
}

static void expect_jobs(tl_renderer *renderer, const struct test_scene *scene, const char *names)
{
    tl_plan foretold;
    tl_renderer_plan(renderer, &scene->frame, &scene->settings, &foretold);
    assert_string_equal(jobs_run(&foretold), names);
    draw(renderer, scene);
    assert_string_equal(jobs_run(tl_renderer_last_plan(renderer)), names);
}

/* Only what a change touches is done again, and tl_renderer_plan says so beforehand. */
static void test_only_what_changed(void **state)
{
    struct test_device *device = *state;
    tl_error error = {0};
    tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
    assert_non_null(renderer);
    struct test_scene scene;
    scene_open(&scene, test_daylight);
    expect_jobs(renderer, &scene, "cube regions lobe pems surfaces maps blur gbuffer light resolve");
    expect_jobs(renderer, &scene, "");
    scene.frame.camera.eye.x += 0.1f;
    expect_jobs(renderer, &scene, "gbuffer light resolve");
    scene.surfaces[1].motion_revision++;
    expect_jobs(renderer, &scene, "surfaces maps blur gbuffer light resolve");
    scene.frame.environment_yaw = 1;
    expect_jobs(renderer, &scene, "maps blur light resolve");
    scene.settings.light.depth_bias_m = 0.01f;
    expect_jobs(renderer, &scene, "light resolve");
    scene.settings.image.exposure_ev = 1;
    expect_jobs(renderer, &scene, "");
    scene.settings.light.method = TL_METHOD_UNSHADOWED;
    expect_jobs(renderer, &scene, "light resolve");
    scene.surfaces[1].motion_revision++;
    expect_jobs(renderer, &scene, "surfaces gbuffer light resolve");
    scene.settings.light.method = TL_METHOD_PEM; /* the maps grew stale meanwhile */
    expect_jobs(renderer, &scene, "maps blur light resolve");
    scene.frame.environment_revision++;
    expect_jobs(renderer, &scene, "cube regions pems maps blur light resolve");
    test_scene_close(&scene);
    tl_renderer_destroy(&renderer);
}

/* In motion so many maps are drawn as light.refresh says and the others show what was; the next frame at rest
 * has all of them, to the bit. */
static void test_maps_wait_and_catch_up(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    tl_error error = {0};
    const int kinds[] = {TL_VISIBILITY_VSM, TL_VISIBILITY_DEPTH};
    for (int k = 0; k < 2; k++) {
        tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
        tl_renderer *fresh = tl_renderer_create(device->gpu, &error);
        scene_open(&scene, test_daylight);
        scene.settings.light.visibility = kinds[k];
        scene.settings.light.refresh = 6;
        draw(renderer, &scene);
        assert_true(tl_renderer_is_at_rest(renderer));
        scene.frame.environment_yaw = 0.7f; /* every shadow falls elsewhere */
        tl_image moving = test_scene_draw(&scene, renderer);
        assert_false(tl_renderer_is_at_rest(renderer));
        tl_image resting = test_scene_draw(&scene, renderer);
        assert_true(tl_renderer_is_at_rest(renderer));
        tl_image rebuilt = test_draw(fresh, &scene.frame, &scene.settings);
        size_t bytes = (size_t)rebuilt.width * (size_t)rebuilt.height * 4 * sizeof(float);
        assert_memory_equal(resting.texels, rebuilt.texels, bytes);
        assert_memory_not_equal(moving.texels, rebuilt.texels, bytes);
        expect_jobs(renderer, &scene, "");
        tl_image_release(&moving);
        tl_image_release(&resting);
        tl_image_release(&rebuilt);
        test_scene_close(&scene);
        tl_renderer_destroy(&fresh);
        tl_renderer_destroy(&renderer);
    }
}

/* An image that reuses earlier results equals one drawn without them. */
static void test_reuse_changes_nothing(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    tl_error error = {0};
    scene_open(&scene, test_daylight);
    draw(device->renderer, &scene);
    scene.frame.camera.eye.y += 0.2f;
    scene.frame.environment_yaw = 0.5f;
    scene.settings.light.lobe = TL_LOBE_SINGLE;
    tl_image kept = test_scene_draw(&scene, device->renderer);
    tl_renderer *fresh = tl_renderer_create(device->gpu, &error);
    tl_image rebuilt = test_draw(fresh, &scene.frame, &scene.settings);
    assert_memory_equal(kept.texels, rebuilt.texels, (size_t)48 * 32 * 4 * sizeof(float));
    tl_renderer_destroy(&fresh);
    tl_image_release(&kept);
    tl_image_release(&rebuilt);
    test_scene_close(&scene);
}

static size_t chain_texels(size_t side)
{
    return (4 * side * side - 1) / 3;
}

/* Computed = allocated: by formula, and by what the GPU floor counts. */
static void test_memory(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    tl_error error = {0};
    scene_open(&scene, test_daylight);
    size_t others = tl_gpu_bytes(device->gpu); /* of the group's renderer */
    tl_renderer *renderer = tl_renderer_create(device->gpu, &error);
    scene.settings.image.supersample = 2;
    for (int regions = 24; regions <= 48; regions += 24) {
        scene.settings.light.regions = regions;
        draw(renderer, &scene);
        struct tl_render_memory memory = tl_renderer_memory(renderer);
        size_t count = (size_t)regions, vertices = 17 * 33 + 17 * 17 + TL_GROUND_VERTICES;
        size_t indices = (16 * 32 + 16 * 16) * 6 + TL_GROUND_INDICES;
        assert_int_equal(memory.pems, count * 6 * 8 * chain_texels(32));
        assert_int_equal(memory.maps, (count * 8 + 8 + 4) * 32 * 32);
        /* Beside the targets: indices and numbers of triangles, twice, places of vertices, depths of samples.
         */
        size_t culled = memory.targets - (48 * 32 * 4 * (16 + 3 * 8 + 4 + 4 + 16) + 48 * 32 * 16);
        assert_in_range(culled, 1, indices / 3 * 32 + vertices * 16 + (size_t)48 * 32 * 4 * 4 + 64);
        assert_int_equal(memory.surfaces, vertices * (12 + 12 + 16 + 8) + indices * 4);
        /* The cube's floats, the regions' labels, luminances, texels and sums, and solid angles; a depth that
         * stands for no maps. */
        size_t kept = (size_t)32 * 32 * (18 * 4 + 6 * (2 + 4 + 4 + 4) + 4);
        assert_int_equal(memory.other, 256 * 4 + 256 * 8 + 4 + kept);
        assert_int_equal(memory.total,
                         memory.pems + memory.maps + memory.targets + memory.surfaces + memory.other);
        assert_int_equal(memory.total - memory.surfaces - kept - culled,
                         tl_gpu_bytes(device->gpu) - others);
    }
    tl_renderer_destroy(&renderer);
    assert_int_equal(tl_gpu_bytes(device->gpu), others);
    test_scene_close(&scene);
}

static void expect_refusal(tl_renderer *renderer, const struct test_scene *scene, const char *part)
{
    tl_error error = {0};
    assert_false(tl_renderer_draw(renderer, &scene->frame, &scene->settings, &error));
    assert_int_equal(error.code, TL_USAGE);
    if (!strstr(error.message, part))
        print_error("%s\n", error.message);
    assert_non_null(strstr(error.message, part));
}

/* Settings that would need more memory than the machine has are refused before any is allocated, and the
 * renderer remains usable. */
static void test_too_large(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, test_daylight);
    const struct tl_render_settings fine = scene.settings;
    scene.settings.light.map_size = 4096;
    expect_refusal(device->renderer, &scene, "lower light.pems_per_pass");
    scene.settings.light.pems_per_pass = 1;
    scene.settings.light.regions = 384;
    expect_refusal(device->renderer, &scene, "lower light.regions");
    scene.settings = fine;
    scene.settings.image.width = 16384;
    scene.settings.image.supersample = 4;
    expect_refusal(device->renderer, &scene, "make image.width");
    scene.settings.image.height = 16384;
    scene.settings.image.supersample = 1;
    expect_refusal(device->renderer, &scene, "make image.width");
    scene.settings = fine;
    draw(device->renderer, &scene);
    test_scene_close(&scene);
}

static void test_not_finite(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    tl_error error = {0};
    scene_open(&scene, test_daylight);
    vec3s kept = scene.shapes[1].mesh.positions[3];
    scene.shapes[1].mesh.positions[3].y = NAN;
    scene.surfaces[1].motion_revision++;
    assert_false(tl_renderer_draw(device->renderer, &scene.frame, &scene.settings, &error));
    assert_int_equal(error.code, TL_UNSTABLE);
    assert_non_null(strstr(error.message, "vertex 3"));
    scene.shapes[1].mesh.positions[3] = kept;
    draw(device->renderer, &scene);
    test_scene_close(&scene);
}

/* Draws, and demands that every channel is finite and not negative, and that coverage is a share. */
static void expect_sane(tl_renderer *renderer, const struct test_scene *scene)
{
    tl_image image = test_scene_draw(scene, renderer);
    for (size_t i = 0; i < (size_t)image.width * (size_t)image.height * 4; i++) {
        float value = tl_image_floats(&image)[i];
        assert_true(isfinite(value) && value >= 0);
        if (i % 4 == 3)
            assert_true(value <= 1);
    }
    tl_image_release(&image);
    tl_error error = {0};
    tl_image shown;
    assert_ok(tl_renderer_show_image(renderer, &shown, &error), error);
    tl_image_release(&shown);
}

static void test_extreme_light(void **state)
{
    struct test_device *device = *state;
    vec3s (*const lights[])(vec3s) = {test_black, spark, test_daylight};
    for (int i = 0; i < 3; i++)
        for (int g = 0; g <= 2; g++)
            for (int lobe = TL_LOBE_SINGLE; lobe <= TL_LOBE_DUAL; lobe++) {
                struct test_scene scene;
                scene_open(&scene, lights[i]);
                scene.shapes[0].material.glossiness = 0.5f * (float)g;
                scene.settings.light.lobe = lobe;
                expect_sane(device->renderer, &scene);
                test_scene_close(&scene);
            }
}

static void test_extreme_settings(void **state)
{
    struct test_device *device = *state;
    const struct {
        int regions, pem_size, map_size, per_pass;
        float blur_m;
    } cases[] = {{6, 4, 1, 1, 10},   {384, 16, 2, 64, 10}, {13, 5, 3, 12, 0},
                 {6, 512, 16, 1, 0}, {6, 8, 256, 6, 10},   {6, 8, 4096, 1, 0}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        struct test_scene scene;
        scene_open(&scene, test_daylight);
        scene.settings.light.regions = cases[i].regions;
        scene.settings.light.pem_size = cases[i].pem_size;
        scene.settings.light.map_size = cases[i].map_size;
        scene.settings.light.pems_per_pass = cases[i].per_pass;
        scene.settings.light.blur_m = cases[i].blur_m;
        scene.settings.light.min_variance = 0;
        scene.settings.light.depth_bias_m = 0;
        expect_sane(device->renderer, &scene);
        test_scene_close(&scene);
    }
}

/* Normals of length 0, triangles of no area, no tangents, 1 mm and 100 m, nothing at all. */
static void test_extreme_shapes(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, test_daylight);
    struct test_shape *sheet = &scene.shapes[1];
    for (size_t i = 0; i < sheet->mesh.vertex_count; i++)
        sheet->mesh.normals[i] = (vec3s){{0, 0, 0}};
    for (size_t i = 0; i < 60; i++)
        sheet->mesh.indices[i] = sheet->mesh.indices[0];
    test_shape_refresh(sheet);
    scene.surfaces[1] = sheet->surface;
    scene.surfaces[1].tangents = NULL;
    expect_sane(device->renderer, &scene);
    const float scales[] = {1e-3f, 1e2f};
    for (int s = 0; s < 2; s++) {
        for (int k = 0; k < 2; k++) {
            struct test_shape *shape = &scene.shapes[k];
            for (size_t i = 0; i < shape->mesh.vertex_count; i++)
                shape->mesh.positions[i] =
                    glms_vec3_scale(shape->mesh.positions[i], s == 0 ? scales[0] : scales[1] / scales[0]);
            test_shape_refresh(shape);
            scene.surfaces[k] = shape->surface;
        }
        scene.frame.camera.eye = glms_vec3_scale((vec3s){{1, 1.5f, 2}}, scales[s]);
        scene.frame.camera.near_m = 0.01f * scales[s];
        scene.frame.camera.far_m = 100 * scales[s];
        expect_sane(device->renderer, &scene);
    }
    scene.frame.surface_count = 0;
    expect_sane(device->renderer, &scene);
    test_scene_close(&scene);
}

static void expect_camera_refusal(tl_renderer *renderer, const struct test_scene *scene)
{
    tl_error error = {0};
    assert_false(tl_renderer_draw(renderer, &scene->frame, &scene->settings, &error));
    assert_int_equal(error.code, TL_USAGE);
    assert_non_null(strstr(error.message, "camera"));
}

/* Anywhere is fine; what has no upright, or no depth, is refused. */
static void test_extreme_cameras(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, test_daylight);
    const struct tl_camera usual = scene.frame.camera;
    const vec3s eyes[] = {{{0, 0, 0}}, {{0.1f, 0.5f, 0}}, {{0.1f, 1.1f, 0}}, {{1, 0, 1}}};
    for (size_t i = 0; i < TL_COUNT(eyes); i++) {
        scene.frame.camera = usual;
        scene.frame.camera.eye = eyes[i]; /* inside the ball, in the sheet, above, in the ground */
        scene.frame.camera.target = (vec3s){{0, 0.6f, 0.2f}};
        expect_sane(device->renderer, &scene);
    }
    scene.frame.camera = usual;
    scene.frame.camera.fov_y = 0;
    expect_sane(device->renderer, &scene);
    scene.frame.camera = usual;
    scene.frame.camera.eye = usual.target;
    expect_camera_refusal(device->renderer, &scene);
    scene.frame.camera = usual;
    scene.frame.camera.far_m = scene.frame.camera.near_m;
    expect_camera_refusal(device->renderer, &scene);
    scene.frame.camera = usual;
    scene.frame.camera.up = (vec3s){{0, 0, 0}};
    expect_camera_refusal(device->renderer, &scene);
    test_scene_close(&scene);
}

/* Coverage of supersampled pixels is the share of samples: a square over the left half of an odd image covers
 * half of the middle column. */
static void test_coverage(void **state)
{
    struct test_device *device = *state;
    tl_environment environment = test_environment(64, 32, test_daylight);
    struct test_shape square = test_square((vec3s){{-1, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 1, 1);
    test_shape_refresh(&square);
    tl_frame frame = test_frame((vec3s){{0, 0, 3}}, (vec3s){{0, 0, 0}}, 10, &square.surface, 1, &environment);
    struct tl_render_settings settings = test_settings(9, 9);
    settings.image.supersample = 4;
    tl_image image = test_draw(device->renderer, &frame, &settings);
    for (int x = 0; x < 9; x++)
        assert_near(test_pixel(&image, x, 4)[3], x < 4 ? 1 : x == 4 ? 0.5 : 0, 0);
    for (int c = 0; c < 3; c++) /* premultiplied: the half-covered pixel is half as bright */
        assert_near(test_pixel(&image, 4, 4)[c], 0.5 * (double)test_pixel(&image, 3, 4)[c], 0.02);
    assert_near(test_pixel(&image, 8, 8)[0], 0, 0);
    tl_image_release(&image);
    test_shape_release(&square);
    tl_environment_release(&environment);
}

/* Shown grey: 18 % background is sRGB 118; a lit white far above 1 is close to white, never beyond. */
static void test_show(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    tl_error error = {0};
    scene_open(&scene, test_daylight);
    scene.settings.image.background = TL_BACKGROUND_GREY;
    scene.settings.image.ground = false;
    scene.settings.image.exposure_ev = -20;
    tl_image shown;
    draw(device->renderer, &scene);
    assert_ok(tl_renderer_show_image(device->renderer, &shown, &error), error);
    const uint8_t *corner = tl_image_bytes(&shown);
    /* Khronos PBR Neutral takes 0.04 off a grey of 0.18: 0.14 is sRGB 105. */
    for (int c = 0; c < 3; c++)
        assert_in_range(corner[c], 104, 106);
    tl_image_release(&shown);
    test_scene_close(&scene);
}

/* Another look in the same surfaces, as when two are compared, does not change the image that was drawn. */
static void test_show_what_was_drawn(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    tl_error error = {0};
    scene_open(&scene, test_daylight);
    scene.settings.light.visibility = TL_VISIBILITY_RAYS;
    scene.settings.light.composition = TL_COMPOSE_RATIO;
    tl_image shown, before, after;
    draw(device->renderer, &scene);
    assert_ok(tl_renderer_read(device->renderer, &before, &error), error);
    tl_material *material = &scene.shapes[1].material;
    material->openness = 0.5f;
    material->gloss.model = TL_REFLECT_WARD;
    material->gloss.width_weft = 0.3f;
    material->gloss.width_warp = 0.1f;
    assert_ok(tl_renderer_show_image(device->renderer, &shown, &error), error);
    assert_ok(tl_renderer_read(device->renderer, &after, &error), error);
    assert_memory_equal(before.texels, after.texels, (size_t)48 * 32 * 4 * sizeof(float));
    tl_image_release(&shown);
    tl_image_release(&before);
    tl_image_release(&after);
    test_scene_close(&scene);
}

static vec3s four_colours(vec3s d)
{
    if (fabsf(d.y) > 0.5f)
        return (vec3s){{0, 0, 0}};
    if (fabsf(d.x) > fabsf(d.z))
        return d.x > 0 ? (vec3s){{0.5f, 0, 0}} : (vec3s){{0, 0.5f, 0}};
    return d.z > 0 ? (vec3s){{0.5f, 0.5f, 0}} : (vec3s){{0, 0, 0.5f}};
}

static void expect_shown(struct test_device *device, const struct test_scene *scene, int red, int green,
                         int blue)
{
    tl_error error = {0};
    tl_image shown;
    draw(device->renderer, scene);
    assert_ok(tl_renderer_show_image(device->renderer, &shown, &error), error);
    const uint8_t *middle = tl_image_bytes(&shown) + (size_t)3 * (16 * 48 + 24);
    assert_near(middle[0], red, 1);
    assert_near(middle[1], green, 1);
    assert_near(middle[2], blue, 1);
    tl_image_release(&shown);
}

/* The background is where the light comes from: -Z in the middle, +X to the right of it; a quarter of yaw
 * brings +X there. 0.5 is sRGB 188; the tone mapper's offset is 0 where a channel is 0. */
static void test_background_direction(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    scene_open(&scene, four_colours);
    scene.frame.surface_count = 0;
    scene.settings.image.ground = false;
    scene.settings.image.background = TL_BACKGROUND_ENVIRONMENT;
    scene.frame.camera.eye = (vec3s){{0, 1, 0}};
    scene.frame.camera.target = (vec3s){{0, 1, -1}};
    expect_shown(device, &scene, 0, 0, 188);
    scene.frame.environment_yaw = (float)M_PI / 2;
    expect_shown(device, &scene, 188, 0, 0);
    scene.frame.environment_yaw = 0;
    scene.frame.camera.target = (vec3s){{-1, 1, 0}};
    expect_shown(device, &scene, 0, 188, 0);
    test_scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_only_what_changed),
        cmocka_unit_test(test_maps_wait_and_catch_up),
        cmocka_unit_test(test_reuse_changes_nothing),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_too_large),
        cmocka_unit_test(test_not_finite),
        cmocka_unit_test(test_extreme_light),
        cmocka_unit_test(test_extreme_settings),
        cmocka_unit_test(test_extreme_shapes),
        cmocka_unit_test(test_extreme_cameras),
        cmocka_unit_test(test_coverage),
        cmocka_unit_test(test_show),
        cmocka_unit_test(test_show_what_was_drawn),
        cmocka_unit_test(test_background_direction),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
