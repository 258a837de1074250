/* Normals near an outline: where interpolated ones point away from the viewer, cloth that has gloss only
 * still shows it. Without detail_facing the outline of a satin ball has black pixels. */
#include "tests/render/scenes.h"

#include "render/reference/reference.h"

#include "tests/testing.h"

#include <float.h>

#define SIZE 64

static const vec3s origin = {{0, 0, 0}};

/* A ball of few triangles, so that normals differ much from what they stand for. */
static void open_ball(struct test_scene *scene)
{
    test_scene_open(scene, test_environment(32, 16, test_white), (vec3s){{0, 0.5f, 2}}, origin, 30, SIZE,
                    SIZE);
    test_scene_use_rays(scene, 48, 4);
    tl_material *satin = test_scene_add(scene, test_sphere(origin, 0.4f, 12));
    satin->diffuse = (vec3s){{0, 0, 0}};
    satin->specular = (vec3s){{0.5f, 0.5f, 0.5f}};
    satin->gloss = (struct tl_gloss){.model = TL_REFLECT_WARD,
                                     .ward = TL_WARD_BOUNDED,
                                     .width_weft = 0.3f,
                                     .width_warp = 0.1f,
                                     .index = 1};
    test_scene_refresh(scene);
}

/* The least light of a whole pixel over the greatest. */
static double darkest(const tl_image *image)
{
    float minimum = FLT_MAX, maximum = 0;
    for (int i = 0; i < image->width * image->height; i++) {
        const float *texel = tl_image_floats(image) + 4 * i;
        if (!(texel[3] > 0.999f))
            continue;
        minimum = fminf(minimum, texel[1]);
        maximum = fmaxf(maximum, texel[1]);
    }
    return (double)(minimum / maximum);
}

static void check(const char *name, tl_image image)
{
    double share = darkest(&image);
    print_message("%s: the darkest pixel has %.2f of the brightest one's light\n", name, share);
    assert_true(share > 0.2);
    tl_image_release(&image);
}

static void outlines_are_lit(void **state)
{
    const struct test_device *device = *state;
    struct test_scene scene;
    tl_error error = {0};
    struct tl_reference_report report;
    tl_image image;
    open_ball(&scene);
    scene.settings.light.ratio_at = TL_RATIO_AT_SAMPLES;
    check("samples", test_scene_draw(&scene, device->renderer));
    scene.settings.light.ratio_at = TL_RATIO_AT_VERTICES;
    check("vertices", test_scene_draw(&scene, device->renderer));
    const struct tl_reference_request request =
        tl_frame_reference_request(&scene.frame, &scene.settings, NULL);
    assert_ok(tl_reference_draw(&request, &image, &report, &error), error);
    check("reference", image);
    test_scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(outlines_are_lit)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
