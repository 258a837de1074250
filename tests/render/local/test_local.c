/* Lamps: the exact way of shading against the CPU, shadows against the oracle, what a scene without lamps
 * pays, and extremes. */
#include "tests/render/scenes.h"

#include "render/local/lamp.h"

#include "tests/testing.h"

#include <string.h>

static const char *const models[] = {"phong", "blinn_phong", "cosine_lobe", "torrance_sparrow",
                                     "ward",  "banks"};

static struct test_shape shiny_sphere(int segments)
{
    struct test_shape shape = test_sphere((vec3s){{0, 0, 0}}, 0.7f, segments);
    shape.material.diffuse = (vec3s){{0.5f, 0.3f, 0.2f}};
    shape.material.specular = (vec3s){{0.3f, 0.2f, 0.1f}};
    shape.material.glossiness = 0.9f;
    return shape;
}

/* Normals and points are interpolated alike, so that single precision is all that is left: a few digits of
 * its seven are lost in powers and where facets are narrow. */
static void equals_the_cpu(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    test_scene_open_lamplit(&scene, shiny_sphere(24), 64, 64);
    struct tl_gloss *gloss = &scene.shapes[0].material.gloss;
    scene.lamps[1] = test_lamp_at((vec3s){{0.8f, 0.3f, 1.5f}}, 1);
    scene.frame.lamp_count = 2;
    for (int model = TL_REFLECT_PHONG; model <= TL_REFLECT_BANKS; model++)
        for (int variant = 0; variant < 5; variant++) {
            gloss->model = model;
            gloss->facets = variant == 1  ? TL_FACETS_GGX
                            : variant & 1 ? TL_FACETS_BECKMANN
                                          : TL_FACETS_GAUSSIAN;
            gloss->masking = variant == 4  ? TL_MASKING_SCHLICK
                             : variant & 2 ? TL_MASKING_V_GROOVES
                                           : TL_MASKING_SMITH;
            gloss->ward = variant & 2 ? TL_WARD_BOUNDED : TL_WARD_PUBLISHED;
            gloss->fresnel = variant % 3;
            gloss->index = 1.5f;
            gloss->extinction = 2;
            gloss->width_weft = variant == 0 ? 0 : 0.3f;
            gloss->width_warp = variant == 0 ? 0 : 0.12f;
            gloss->rotation = 0.4f * (float)variant;
            scene.shapes[0].material.thread_count = gloss->model == TL_REFLECT_PHONG ? 0 : variant % 3;
            scene.shapes[0].material.threads[0] = (struct tl_thread){{{0.4f, 1, 2}}, 0.45f, 0.12f};
            scene.shapes[0].material.threads[1] = (struct tl_thread){{{1, 0.2f, 0}}, 0.2f, 0.5f};
            test_scene_refresh(&scene);
            tl_image expected = test_scene_evaluate(&scene);
            struct test_difference off = test_scene_error(&scene, device->renderer, &expected);
            tl_image_release(&expected);
            print_message("%-17s %d: rel. RMSE %.2e, largest %.2e of the peak, %zu pixels\n", models[model],
                          variant, off.rel_rmse, off.largest, off.pixels);
            assert_true(off.pixels > 800);
            assert_true(off.rel_rmse < 2e-5 + off.moved_rmse);
            assert_true(off.largest < 2e-5 + off.moved_largest);
        }
    test_scene_close(&scene);
}

/* A lamp shines from +Z at no yaw, from +X at a quarter, from above at a pitch of a quarter; a point lamp
 * stands there. */
static void lamps_shine_from_where_options_say(void **state)
{
    (void)state;
    static const struct {
        float yaw_deg, pitch_deg;
        vec3s from;
    } cases[] = {{0, 0, {{0, 0, 1}}},
                 {90, 0, {{1, 0, 0}}},
                 {-90, 0, {{-1, 0, 0}}},
                 {30, 90, {{0, 1, 0}}},
                 {0, -90, {{0, -1, 0}}}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct tl_lamp_params params = {.kind = TL_LAMP_POINT,
                                              .yaw_deg = cases[i].yaw_deg,
                                              .pitch_deg = cases[i].pitch_deg,
                                              .distance_m = 2};
        struct tl_lamp lamp = tl_lamp_make(&params, (vec3s){{1, 2, 3}});
        for (int c = 0; c < 3; c++) {
            assert_near(lamp.direction.raw[c], cases[i].from.raw[c], 1e-6);
            assert_near(lamp.position.raw[c], (float)(c + 1) + 2 * cases[i].from.raw[c], 1e-5);
        }
    }
}

/* The back of a sheet is a surface of its own, whose threads run as they do on the front. */
static void backs_equal_the_cpu(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    struct test_shape sheet = test_sheet(0, 0.8f, 0.1f, 2, 32);
    sheet.material.specular = (vec3s){{0.3f, 0.3f, 0.3f}};
    sheet.material.gloss = (struct tl_gloss){
        .model = TL_REFLECT_WARD, .width_weft = 0.4f, .width_warp = 0.1f, .rotation = 0.5f, .index = 1.5f};
    test_scene_open_lamplit(&scene, sheet, 96, 96);
    scene.frame.camera.eye = (vec3s){{0.5f, -2, 1.5f}};
    scene.lamps[0] = test_lamp_towards((vec3s){{-0.5f, -1, 0.5f}}, 3);
    tl_image expected = test_scene_evaluate(&scene);
    struct test_difference off = test_scene_error(&scene, device->renderer, &expected);
    tl_image_release(&expected);
    print_message("backs: rel. RMSE %.2e of %zu pixels\n", off.rel_rmse, off.pixels);
    assert_true(off.pixels > 1000);
    assert_true(off.rel_rmse < 5e-5 + off.moved_rmse);
    test_scene_close(&scene);
}

/* Against the ray traced oracle, with shadows of every back-end and a ground. Rays differ from it at edges of
 * shadows only: a pixel of it in a hundred. Maps have texels of 2 to 4 mm, half a pixel, on a shadow's edge.
 */
static void shadows_equal_the_reference(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    test_scene_open_lamplit(&scene, shiny_sphere(32), 96, 96);
    test_scene_add(&scene, test_sheet(-0.9f, 1.2f, 0.05f, 2, 48));
    scene.frame.camera.eye = (vec3s){{0.3f, 1.5f, 3}};
    scene.settings.light.method = TL_METHOD_PEM;
    scene.settings.light.jitter = false;
    scene.settings.shading.self_shadow = TL_SELF_SHADOW_STEP;
    const struct tl_lamp lamps[] = {test_lamp_towards((vec3s){{-0.6f, 0.9f, 0.4f}}, 3),
                                    test_lamp_at((vec3s){{-2, 3, 1}}, 30),
                                    test_lamp_at((vec3s){{0.9f, 0.5f, 0.6f}}, 2)};
    for (int kind = 0; kind < 3; kind++) {
        scene.lamps[0] = lamps[kind];
        scene.settings.light.method = TL_METHOD_REFERENCE;
        scene.settings.reference.replicates = 1;
        scene.settings.reference.strata = 1;
        tl_image expected = test_scene_draw(&scene, device->renderer);
        scene.settings.light.method = TL_METHOD_PEM;
        static const char *const names[] = {"vsm", "depth", "rays"};
        for (int visibility = TL_VISIBILITY_DEPTH; visibility <= TL_VISIBILITY_RAYS; visibility++) {
            scene.settings.light.visibility = visibility;
            struct test_difference off = test_scene_error(&scene, device->renderer, &expected);
            print_message("lamp %d, %s: rel. RMSE %.4f\n", kind, names[visibility], off.rel_rmse);
            assert_true(off.rel_rmse < (visibility == TL_VISIBILITY_RAYS ? 0.04 : 0.08));
        }
        tl_image_release(&expected);
    }
    test_scene_close(&scene);
}

/* Coats; holes and the surfaces behind them; transmission; mirrors of lit surfaces: under a lamp, against the
 * reference. The remaining differences are edges of shadows and of what holes and mirrors show. */
static void layers_equal_the_reference(void **state)
{
    struct test_device *device = *state;
    for (int kind = 0; kind < 6; kind++) {
        struct test_scene scene;
        test_scene_open_lamplit(&scene, shiny_sphere(32), 96, 96);
        tl_material *ball = &scene.shapes[0].material;
        if (kind == 4)
            ball->diffuse_roughness = 0.7f;
        if (kind == 5)
            ball->gloss = (struct tl_gloss){.model = TL_REFLECT_BANKS, .rotation = 0.5f, .index = 1.5f};
        if (kind == 3) /* fibres over a coat */
            ball->fuzz = (struct tl_fuzz){{{1, 0.8f, 0.5f}}, 0.5f, 0};
        if (kind == 0 || kind == 3) { /* a coat over Ward */
            ball->gloss = (struct tl_gloss){
                .model = TL_REFLECT_WARD, .width_weft = 0.3f, .width_warp = 0.15f, .index = 1.5f};
            ball->coat = 0.8f;
            ball->coat_glossiness = 0.97f;
        } else if (kind < 3) {
            test_scene_add(&scene,
                           test_square((vec3s){{0.2f, 0, kind == 1 ? 1.0f : -0.9f}}, (vec3s){{1, 0, 0}},
                                       (vec3s){{0, 0, 1}}, kind == 1 ? 0.4f : 1.5f, 8));
            tl_material *square = &scene.shapes[1].material;
            if (kind == 1) { /* voile before the sphere, lit from behind itself */
                square->openness = 0.5f;
                square->transmission = (vec3s){{0.4f, 0.3f, 0.2f}};
                scene.lamps[1] = test_lamp_at((vec3s){{0.9f, 0.9f, 0.4f}}, 2);
                scene.frame.lamp_count = 2;
            } else { /* a mirror behind it */
                square->specular = (vec3s){{0.9f, 0.9f, 0.9f}};
                square->diffuse = (vec3s){{0, 0, 0}};
                square->glossiness = 1;
                ball->glossiness = 0.5f;
                scene.lamps[0] = test_lamp_at((vec3s){{0.9f, 0.8f, -0.5f}}, 2);
                scene.frame.camera.eye.x = 1.5f;
            }
        }
        test_scene_refresh(&scene);
        scene.settings.light.visibility = TL_VISIBILITY_RAYS;
        scene.settings.light.reflect_scene = true;
        scene.settings.shading.self_shadow = TL_SELF_SHADOW_STEP;
        scene.settings.light.method = TL_METHOD_REFERENCE;
        scene.settings.reference.replicates = scene.settings.reference.strata = 1;
        tl_image expected = test_scene_draw(&scene, device->renderer);
        scene.settings.light.method = TL_METHOD_PEM;
        struct test_difference off = test_scene_error(&scene, device->renderer, &expected);
        static const char *const names[] = {"coat", "voile", "mirror", "fuzz", "rough", "threads"};
        print_message("%s: rel. RMSE %.4f, largest %.3f of the peak, %zu pixels\n", names[kind], off.rel_rmse,
                      off.largest, off.pixels);
        assert_true(off.pixels > 2000);
        assert_true(off.rel_rmse < 0.05);
        if (kind == 0 || kind >= 3)
            assert_true(off.rel_rmse < 1e-3);
        if (kind == 2) { /* there is something to see in it */
            scene.settings.light.reflect_scene = false;
            assert_true(test_scene_error(&scene, device->renderer, &expected).rel_rmse > 0.2);
        }
        tl_image_release(&expected);
        test_scene_close(&scene);
    }
}

static const struct tl_plan_row *row_of(const tl_plan *plan, const char *name)
{
    for (int i = 0; i < plan->count; i++)
        if (strcmp(plan->rows[i].name, name) == 0)
            return &plan->rows[i];
    fail_msg("no job %s", name);
    return NULL;
}

/* No lamp, no job, program, texture or byte; and none is left when the last lamp goes out. */
static void costs_nothing_without_lamps(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    test_scene_open_lamplit(&scene, shiny_sphere(16), 32, 32);
    scene.settings.light.method = TL_METHOD_PEM;
    scene.settings.light.visibility = TL_VISIBILITY_DEPTH;
    scene.frame.lamp_count = 0;
    tl_image dark = test_scene_draw(&scene, device->renderer);
    size_t bytes = tl_renderer_memory(device->renderer).total, texture_bytes = tl_gpu_bytes(device->gpu);
    const tl_plan *plan = tl_renderer_last_plan(device->renderer);
    static const char *const jobs[] = {"lamps", "lamp_maps", "lamp_rays"};
    for (size_t i = 0; i < 3; i++)
        assert_int_equal(row_of(plan, jobs[i])->action, TL_JOB_DROP);
    assert_non_null(strstr(row_of(plan, "lamps")->reason, "no lamps"));

    scene.settings.shading.frequency = TL_FREQUENCY_GOURAUD; /* no surface uses it */
    tl_image again = test_scene_draw(&scene, device->renderer);
    assert_int_equal(row_of(tl_renderer_last_plan(device->renderer), "light")->action, TL_JOB_REUSE);
    tl_image_release(&again);

    scene.frame.lamp_count = 1;
    tl_image lit = test_scene_draw(&scene, device->renderer);
    assert_int_equal(row_of(tl_renderer_last_plan(device->renderer), "lamps")->action, TL_JOB_RUN);
    assert_true(tl_renderer_memory(device->renderer).total > bytes);
    tl_image_release(&lit);

    scene.lamps[0].irradiance = (vec3s){{0, 0, 0}}; /* a lamp that is out is none */
    tl_image out = test_scene_draw(&scene, device->renderer);
    assert_int_equal(tl_renderer_memory(device->renderer).total, bytes);
    assert_int_equal(tl_gpu_bytes(device->gpu), texture_bytes);
    assert_memory_equal(out.texels, dark.texels, (size_t)32 * 32 * 4 * sizeof(float));
    tl_image_release(&out);
    tl_image_release(&dark);
    test_scene_close(&scene);
}

static vec3s daylight(vec3s d)
{
    return (vec3s){{0.5f, 0.6f, 0.7f + 0.3f * d.y}};
}

/* Drawing again, averaging rounds and changing the lamp leave each lamp's light in the image once. */
static void adds_once(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    test_scene_open_lamplit(&scene, shiny_sphere(16), 32, 32);
    tl_environment_release(&scene.environment);
    scene.environment = test_environment(16, 8, daylight);
    scene.frame.environment_revision += 1000;
    scene.settings.light.method = TL_METHOD_PEM;
    for (int visibility = TL_VISIBILITY_DEPTH; visibility <= TL_VISIBILITY_RAYS; visibility++) {
        scene.settings.light.visibility = visibility;
        scene.settings.light.jitter = true;
        scene.settings.light.rounds = 8;
        scene.frame.lamp_count = 0;
        tl_image without = test_scene_draw(&scene, device->renderer);
        for (int round = 0; round < 8; round++) {
            tl_image_release(&without);
            without = test_scene_draw(&scene, device->renderer);
        }
        scene.frame.lamp_count = 1;
        tl_image with = test_scene_draw(&scene, device->renderer);
        for (int round = 0; round < 8; round++) {
            scene.lamps[0].irradiance.y = round < 4 ? 9.0f : 2.7f; /* changed, and changed back */
            tl_image_release(&with);
            with = test_scene_draw(&scene, device->renderer);
        }
        for (int round = 0; round < 8; round++) {
            tl_image_release(&with);
            with = test_scene_draw(&scene, device->renderer);
        }
        /* The difference must be the light of the lamp alone, as rendered in the dark scene. */
        struct test_scene dark = scene;
        dark.environment = test_environment(8, 4, daylight);
        for (size_t i = 0; i < (size_t)8 * 4 * 3; i++)
            tl_image_floats(&dark.environment.image)[i] = 0;
        dark.frame.environment = &dark.environment;
        dark.frame.environment_revision += 1;
        tl_image lamp = test_scene_draw(&dark, device->renderer);
        double worst = 0;
        for (size_t i = 0; i < (size_t)32 * 32 * 4; i++)
            if (i % 4 < 3)
                worst = fmax(worst,
                             fabs((double)tl_image_floats(&with)[i] - (double)tl_image_floats(&without)[i] -
                                  (double)tl_image_floats(&lamp)[i]));
        print_message("visibility %d: with - without - lamp alone: %.2e\n", visibility, worst);
        assert_true(worst < 2e-3); /* rays are averaged over different rounds */
        tl_image_release(&lamp);
        tl_environment_release(&dark.environment);
        tl_image_release(&with);
        tl_image_release(&without);
    }
    test_scene_close(&scene);
}

/* A lamp in the surface, behind it, at zero distance, absurdly bright or nowhere: finite, and dark where dark
 * it is. */
static void survives_extremes(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    test_scene_open_lamplit(
        &scene, test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 1, 8), 33, 33);
    scene.frame.camera.eye = (vec3s){{0, 0, 2.5f}};
    struct tl_material *material = &scene.shapes[0].material;
    const struct tl_lamp lamps[] = {
        test_lamp_at((vec3s){{0, 0, 0}}, 1),
        test_lamp_at((vec3s){{0, 0, -1e-6f}}, 1),
        test_lamp_at((vec3s){{0, 0, 2.5f}}, 1),
        test_lamp_at((vec3s){{0, 0, -1}}, 1),
        test_lamp_towards((vec3s){{0, 0, -1}}, 1),
        test_lamp_towards((vec3s){{1, 0, 0}}, 1),
        test_lamp_at((vec3s){{1e18f, 0, 0}}, 1e6f),
        test_lamp_towards((vec3s){{0, 0, 1}}, 1e6f),
        {.kind = TL_LAMP_DIRECTIONAL, .irradiance = {{1, 1, 1}}},
        test_lamp_at((vec3s){{NAN, 0, 0}}, 1),
        test_lamp_towards((vec3s){{0, 0, 1}}, INFINITY),
    };
    const bool is_dark[] = {false, true, false, true, true, true, false, false, true, true, true};
    static const float glossinesses[] = {0, 0.5f, 1};
    for (size_t i = 0; i < sizeof lamps / sizeof lamps[0]; i++)
        for (size_t model = 0; model < 6; model++) { /* every glossiness with every lamp and every model */
            scene.lamps[0] = lamps[i];
            scene.settings.light.method = model == 0 ? TL_METHOD_PEM : TL_METHOD_UNSHADOWED;
            material->gloss.model = (int)model;
            material->glossiness = glossinesses[(i + model) % 3];
            test_scene_refresh(&scene);
            tl_image image = test_scene_draw(&scene, device->renderer);
            double sum = 0;
            for (size_t k = 0; k < (size_t)33 * 33 * 4; k++) {
                assert_true(isfinite(tl_image_floats(&image)[k]));
                sum += k % 4 < 3 ? (double)tl_image_floats(&image)[k] : 0;
            }
            if (is_dark[i])
                assert_true(sum == 0);
            tl_image_release(&image);
        }
    test_scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equals_the_cpu),
        cmocka_unit_test(lamps_shine_from_where_options_say),
        cmocka_unit_test(backs_equal_the_cpu),
        cmocka_unit_test(shadows_equal_the_reference),
        cmocka_unit_test(layers_equal_the_reference),
        cmocka_unit_test(costs_nothing_without_lamps),
        cmocka_unit_test(adds_once),
        cmocka_unit_test(survives_extremes),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
