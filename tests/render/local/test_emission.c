/* What surfaces emit, in the dark: against the formula, and against the reference, by every path to a
 * picture. */
#include "tests/render/scenes.h"

#include "tests/testing.h"

#include <math.h>

static const vec3s amber = {{2, 1, 0.25f}};

static void open_dark(struct test_scene *scene, struct test_shape shape)
{
    test_scene_open_lamplit(scene, shape, 96, 96);
    scene->frame.lamp_count = 0;
    scene->shapes[0].material.emission = amber;
    test_scene_refresh(scene);
}

/* cover (1 - openness) (1 - coat) emission, whatever else the material reflects of the dark. */
static void a_plain_material_shows_its_emission(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    open_dark(&scene, test_square((vec3s){{0, 0, 0}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0.12f, 1}}, 0.5f, 4));
    static const struct {
        int method, visibility;
    } paths[] = {{TL_METHOD_UNSHADOWED, TL_VISIBILITY_RAYS}, {TL_METHOD_PEM, TL_VISIBILITY_DEPTH},
                 {TL_METHOD_PEM, TL_VISIBILITY_RAYS},        {TL_METHOD_AO, TL_VISIBILITY_RAYS},
                 {TL_METHOD_MAPS, TL_VISIBILITY_RAYS},       {TL_METHOD_REFERENCE, TL_VISIBILITY_RAYS}};
    scene.settings.light.ratio_at = TL_RATIO_AT_VERTICES; /* has no emission: samples take over */
    scene.settings.reference.replicates = scene.settings.reference.strata = 1;
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++) {
        scene.settings.light.method = paths[i].method;
        scene.settings.light.visibility = paths[i].visibility;
        tl_image image = test_scene_draw(&scene, device->renderer);
        const float *middle = test_pixel(&image, 48, 48), *corner = test_pixel(&image, 1, 1);
        for (int c = 0; c < 3; c++) {
            assert_near(middle[c], amber.raw[c], 2e-3 * (double)amber.raw[c]);
            assert_near(corner[c], 0, 0);
        }
        tl_image_release(&image);
    }
    test_scene_close(&scene);
}

/* A map of 4 x 4 colours, moved, turned and repeated by its transform, under a coat. */
static void maps_and_coats_equal_the_reference(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    uint8_t texels[48];
    for (int i = 0; i < 48; i++)
        texels[i] = (uint8_t)(i * 83 % 256);
    tl_image map = {.width = 4, .height = 4, .channels = 3, .type = TL_IMAGE_U8, .texels = texels};
    open_dark(&scene, test_sphere((vec3s){{0, 0, 0}}, 0.7f, 24));
    tl_material *ball = &scene.shapes[0].material;
    ball->emission_map.image = &map;
    ball->emission_map.transform = (struct tl_uv_transform){{0.3f, 0.1f}, {3, 2}, 0.4f};
    for (int coated = 0; coated < 2; coated++) {
        ball->coat = coated ? 0.9f : 0;
        ball->coat_glossiness = 0.9f;
        test_scene_refresh(&scene);
        scene.settings.light.method = TL_METHOD_REFERENCE;
        scene.settings.reference.replicates = scene.settings.reference.strata = 1;
        tl_image expected = test_scene_draw(&scene, device->renderer);
        scene.settings.light.method = TL_METHOD_PEM;
        scene.settings.light.visibility = TL_VISIBILITY_RAYS;
        struct test_difference off = test_scene_error(&scene, device->renderer, &expected);
        print_message("map, coat %d: rel. RMSE %.4f, largest %.4f of the peak\n", coated, off.rel_rmse,
                      off.largest);
        assert_true(off.pixels > 2000);
        assert_true(off.rel_rmse < 0.01); /* the light target has halves, and mip levels differ by rounding */
        tl_image_release(&expected);
    }
    test_scene_close(&scene);
}

/* Before an emitting ball: an open sheet that emits as well, with a map; beside it: a mirror that shows both.
 */
static void behind_open_sheets_and_in_mirrors(void **state)
{
    struct test_device *device = *state;
    for (int kind = 0; kind < 2; kind++) {
        struct test_scene scene;
        uint8_t texels[12] = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
        tl_image map = {.width = 2, .height = 2, .channels = 3, .type = TL_IMAGE_U8, .texels = texels};
        open_dark(&scene, test_sphere((vec3s){{0, 0, 0}}, 0.7f, 32));
        scene.shapes[0].material.emission_map.image = &map;
        test_scene_add(&scene, test_square((vec3s){{0.2f, 0, kind == 0 ? 1.0f : -0.9f}}, (vec3s){{1, 0, 0}},
                                           (vec3s){{0, 0, 1}}, kind == 0 ? 0.4f : 1.5f, 8));
        tl_material *square = &scene.shapes[1].material;
        square->diffuse = (vec3s){{0, 0, 0}};
        if (kind == 0) {
            square->openness = 0.5f;
            square->emission = (vec3s){{0.1f, 0.2f, 0.3f}};
        } else {
            square->specular = (vec3s){{0.9f, 0.9f, 0.9f}};
            square->glossiness = 1;
            scene.frame.camera.eye.x = 1.5f;
        }
        test_scene_refresh(&scene);
        scene.settings.light.visibility = TL_VISIBILITY_RAYS;
        scene.settings.light.reflect_scene = true;
        scene.settings.reference.replicates = scene.settings.reference.strata = 1;
        scene.settings.light.method = TL_METHOD_REFERENCE;
        tl_image expected = test_scene_draw(&scene, device->renderer);
        scene.settings.light.method = TL_METHOD_PEM;
        struct test_difference off = test_scene_error(&scene, device->renderer, &expected);
        print_message("%s: rel. RMSE %.4f, largest %.3f of the peak, %zu pixels\n",
                      kind == 0 ? "sheet" : "mirror", off.rel_rmse, off.largest, off.pixels);
        assert_true(off.pixels > 2000);
        assert_true(off.rel_rmse < 0.05); /* edges of what mirrors show, as for lamps */
        tl_image_release(&expected);
        test_scene_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plain_material_shows_its_emission),
        cmocka_unit_test(maps_and_coats_equal_the_reference),
        cmocka_unit_test(behind_open_sheets_and_in_mirrors),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
