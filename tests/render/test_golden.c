/* One scene by every method of light, against the images kept in tests/render/golden/ (tests/golden.h). */
#include "tests/render/scenes.h"

#include "config/base/memory.h"

#include "tests/golden.h"

static vec3s room(vec3s d)
{
    if (glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.5f, 0.8f, 0.6f}})) > 0.99f)
        return (vec3s){{90, 80, 60}};
    if (d.x < -0.8f && fabsf(d.y) < 0.4f)
        return (vec3s){{2, 3, 4}};
    return (vec3s){{0.3f + 0.1f * d.y, 0.3f, 0.35f - 0.1f * d.y}};
}

/* ... whose lamp is a sun, a degree across. */
static vec3s sunny_room(vec3s d)
{
    vec3s light = room(d);
    if (glms_vec3_dot(d, glms_vec3_normalize((vec3s){{0.5f, 0.8f, 0.6f}})) > 0.9995f)
        return (vec3s){{1800, 1600, 1200}};
    return light.x > 80 ? (vec3s){{0.3f, 0.3f, 0.3f}} : light;
}

/* A ball under a waved sheet on the ground, half a cloth of coarse weave behind them. */
/* A plain weave drawn with sines, 8 texels a yarn. */
static tl_weave coarse_weave(void)
{
    tl_weave weave = {.size_m = {0.08f, 0.08f},
                      .normal = tl_image_create(16, 16, 3, TL_IMAGE_U8),
                      .height = tl_image_create(16, 16, 1, TL_IMAGE_F32),
                      .gloss = tl_image_create(16, 16, 1, TL_IMAGE_F32),
                      .tint = tl_image_create(16, 16, 3, TL_IMAGE_F32)};
    weave.normal.linear = true;
    for (int i = 0; i < 16 * 16; i++) {
        int column = i % 16, row = i / 16;
        float u = ((float)column + 0.5f) * (float)M_PI / 8, v = ((float)row + 0.5f) * (float)M_PI / 8;
        vec3s n = glms_vec3_normalize((vec3s){{0.5f * cosf(u) * sinf(v), 0.5f * sinf(u) * cosf(v), 1}});
        for (int c = 0; c < 3; c++) {
            tl_image_bytes(&weave.normal)[3 * i + c] = (uint8_t)lroundf(127.5f + 127.5f * n.raw[c]);
            tl_image_floats(&weave.tint)[3 * i + c] = sinf(u) * sinf(v) > 0 ? 1 : 0.4f + 0.2f * (float)c;
        }
        tl_image_floats(&weave.gloss)[i] = 0.2f * sinf(u) * sinf(v);
    }
    return weave;
}

static void scene_open(struct test_scene *scene, bool has_sun)
{
    test_scene_open(scene, has_sun ? test_environment(256, 128, sunny_room) : test_environment(128, 64, room),
                    (vec3s){{0.6f, 1.3f, 2.4f}}, (vec3s){{-0.1f, 0.5f, 0}}, 35, 96, 64);
    scene->weave = coarse_weave();
    test_scene_add(scene, test_sphere((vec3s){{0.1f, 0.35f, 0}}, 0.35f, 24));
    test_scene_add(scene, test_sheet(0.95f, 0.4f, 0.05f, 1.5f, 32));
    test_scene_add(scene, test_square((vec3s){{-0.6f, 0.5f, -0.3f}}, (vec3s){{0.8f, 0, 0.6f}},
                                      (vec3s){{-0.6f, 0, 0.8f}}, 0.4f, 4));
    scene->shapes[0].material.diffuse = (vec3s){{0.1f, 0.1f, 0.4f}};
    scene->shapes[0].material.specular = (vec3s){{0.5f, 0.5f, 0.5f}};
    scene->shapes[0].material.glossiness = 0.95f;
    scene->shapes[1].material.diffuse = (vec3s){{0.6f, 0.2f, 0.1f}};
    scene->shapes[1].material.glossiness = 0.6f;
    scene->shapes[2].material.weave = &scene->weave;
    scene->settings.light.map_size = 128;
    scene->settings.image.ground = true;
    scene->settings.image.supersample = 2;
}

static void draw_and_check(struct test_device *device, const char *name, enum tl_method method,
                           enum tl_lobe lobe)
{
    struct test_scene scene;
    scene_open(&scene, false);
    scene.settings.light.method = (int)method;
    scene.settings.light.lobe = (int)lobe;
    tl_image image = test_scene_draw(&scene, device->renderer);
    test_scene_close(&scene);
    golden_check("tests/render/golden", name, &image);
    tl_image_release(&image);
}

/* The map back-end in its best form, as a GPU has it. */
static struct tl_light_params best_maps(struct tl_light_params light)
{
    light.lobe = TL_LOBE_DUAL;
    light.visibility = TL_VISIBILITY_DEPTH;
    light.cut = TL_CUT_SPHERE;
    light.composition = TL_COMPOSE_RATIO;
    light.depth_bias_m = 0.0005f;
    return light;
}

static void in_rounds(struct tl_light_params *light)
{
    light->jitter = true;
    light->rounds = 16;
}

static void from_slices(struct tl_light_params *light)
{
    light->prefilter = TL_PREFILTER_SLICES;
    light->composition = TL_COMPOSE_SUM;
}

static void with_sun(struct tl_light_params *light)
{
    light->sun = true;
    light->pem_size = 64;
}

/* As the preset review has it, with fewer regions. */
static void by_rays(struct tl_light_params *light)
{
    in_rounds(light);
    light->visibility = TL_VISIBILITY_RAYS;
    light->sun = true;
    light->regions = 96;
    light->rays = 1;
    light->rounds = 4;
    light->repair = 0.05f;
}

static void by_rays_with_mirrors(struct tl_light_params *light)
{
    by_rays(light);
    light->reflect_scene = true;
}

/* Draws until nothing changes any more. */
static void draw_variant(struct test_device *device, const char *name, enum tl_method method,
                         void (*change)(struct tl_light_params *))
{
    struct test_scene scene;
    scene_open(&scene, change == with_sun || change == by_rays);
    if (change == by_rays_with_mirrors) {
        scene.shapes[0].material.glossiness = 1;
        test_scene_refresh(&scene);
    }
    scene.settings.light = best_maps(scene.settings.light);
    scene.settings.light.method = (int)method;
    if (change)
        change(&scene.settings.light);
    tl_image image = test_scene_draw(&scene, device->renderer);
    while (!tl_renderer_is_at_rest(device->renderer)) {
        tl_image_release(&image);
        image = test_scene_draw(&scene, device->renderer);
    }
    test_scene_close(&scene);
    golden_check("tests/render/golden", name, &image);
    tl_image_release(&image);
}

static void test_depth_ratio(void **state)
{
    draw_variant(*state, "depth_ratio", TL_METHOD_PEM, NULL);
}

static void test_depth_rounds(void **state)
{
    draw_variant(*state, "depth_rounds", TL_METHOD_PEM, in_rounds);
}

static void test_depth_slices(void **state)
{
    draw_variant(*state, "depth_slices", TL_METHOD_PEM, from_slices);
}

static void test_depth_sun(void **state)
{
    draw_variant(*state, "depth_sun", TL_METHOD_PEM, with_sun);
}

static void test_rays(void **state)
{
    draw_variant(*state, "rays", TL_METHOD_PEM, by_rays);
}

static void test_rays_mirrors(void **state)
{
    draw_variant(*state, "rays_mirrors", TL_METHOD_PEM, by_rays_with_mirrors);
}

static void test_reference(void **state)
{
    draw_variant(*state, "reference", TL_METHOD_REFERENCE, by_rays_with_mirrors);
}

static void test_lights(void **state)
{
    draw_variant(*state, "lights", TL_METHOD_LIGHTS, NULL);
}

static void test_ao(void **state)
{
    draw_variant(*state, "ao", TL_METHOD_AO, NULL);
}

static void test_ao_colour(void **state)
{
    draw_variant(*state, "ao_colour", TL_METHOD_AO_COLOUR, NULL);
}

static void test_unshadowed_exact(void **state)
{
    draw_variant(*state, "unshadowed_exact", TL_METHOD_UNSHADOWED, NULL);
}

static void test_pem_dual(void **state)
{
    draw_and_check(*state, "pem_dual", TL_METHOD_PEM, TL_LOBE_DUAL);
}

static void test_pem_single(void **state)
{
    draw_and_check(*state, "pem_single", TL_METHOD_PEM, TL_LOBE_SINGLE);
}

static void test_unshadowed_dual(void **state)
{
    draw_and_check(*state, "unshadowed_dual", TL_METHOD_UNSHADOWED, TL_LOBE_DUAL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pem_dual),        cmocka_unit_test(test_pem_single),
        cmocka_unit_test(test_unshadowed_dual), cmocka_unit_test(test_depth_ratio),
        cmocka_unit_test(test_depth_rounds),    cmocka_unit_test(test_depth_slices),
        cmocka_unit_test(test_depth_sun),       cmocka_unit_test(test_rays),
        cmocka_unit_test(test_rays_mirrors),    cmocka_unit_test(test_reference),
        cmocka_unit_test(test_lights),          cmocka_unit_test(test_ao),
        cmocka_unit_test(test_ao_colour),       cmocka_unit_test(test_unshadowed_exact),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
