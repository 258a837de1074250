/* Ambient, diffuse and gloss from one table: against the formula, and where that cannot be. Row A3. */
#include "tests/render/scenes.h"

#include "assets/weave/weave.h"
#include "config/base/memory.h"
#include "render/local/table_textures.h"

#include "tests/testing.h"

#include <string.h>

static const char *const models[] = {"phong", "blinn_phong", "cosine_lobe"};

/* The formula with a lamp's even light, which nothing shadows. */
static tl_image formula_of(const struct test_scene *scene)
{
    tl_image image = test_scene_evaluate(scene);
    const struct tl_lamp *lamp = &scene->lamps[0];
    const tl_material *material = &scene->shapes[0].material;
    const float share = scene->settings.shading.ambient / (float)M_PI;
    for (size_t i = 0; i < (size_t)image.width * (size_t)image.height; i++)
        for (size_t c = 0; tl_image_floats(&image)[4 * i + 3] > 0 && c < 3; c++)
            tl_image_floats(&image)[4 * i + c] += share * material->diffuse.raw[c] * lamp->irradiance.raw[c];
    return image;
}

/* The error of a folded table of N x N texels in red, which is the brightest channel: half a step of the
 * texels, and of each of the two interpolations, which filters may carry out in the precision of texels; the
 * chord of a convex power between two of them, s (s - 1) / 8 of the square of their distance; the errors of
 * filters' weights; and the change of Fresnel's term from normal incidence to 87 degrees. */
static double folded_bound(const struct test_scene *scene)
{
    const tl_material *material = &scene->shapes[0].material;
    const struct tl_shading_params *shading = &scene->settings.shading;
    const struct tl_brdf brdf = tl_brdf_of(material, material->specular, material->glossiness);
    const bool half = material->gloss.model == TL_REFLECT_BLINN_PHONG;
    const double s = (half ? 4 : 1) * (double)brdf.exponent, texels = shading->table_size - 1;
    const double apart = (1 - pow(1e-6, 1 / s)) / texels, steps[] = {255, 65535, INFINITY};
    const double f = (double)tl_brdf_fresnel(&brdf, 1).x, away = (double)tl_brdf_fresnel(&brdf, 0.05f).x;
    const double gloss = f * (double)tl_brdf_lobe_scale(&brdf),
                 even = (double)material->diffuse.x * (1 + (double)shading->ambient) / M_PI;
    return (double)scene->lamps[0].irradiance.x *
           ((even + gloss) * 1.5 / steps[shading->table_precision] + gloss * s * (s - 1) / 8 * apart * apart +
            TEST_WEIGHT * (gloss * s * apart + (even + gloss) / texels) +
            fabs(f - away) * (double)tl_brdf_lobe_scale(&brdf) + 1e-5);
}

static void assert_near_formula(struct test_device *device, const struct test_scene *scene, const char *what)
{
    tl_image formula = formula_of(scene);
    struct test_difference off = test_scene_error(scene, device->renderer, &formula);
    double peak = test_brightest(&formula), bound = folded_bound(scene) / peak;
    print_message("%-30s precision %d: largest %.1e of the peak %.2f (bound %.1e, moved %.1e)\n", what,
                  scene->settings.shading.table_precision, off.largest, peak, bound, off.moved_largest);
    assert_true(off.pixels > 1000);
    assert_true(off.largest < bound + off.moved_largest);
    tl_image_release(&formula);
}

/* A metal without loss, whose Fresnel's term is 1 at all angles: the formula of the paper's models, which
 * have none. */
static struct test_shape even_sheet(int model)
{
    struct test_shape shape = test_sheet(0, 0.8f, 0.08f, 1.5f, 48);
    shape.material.diffuse = (vec3s){{0.5f, 0.3f, 0.2f}};
    shape.material.specular = (vec3s){{0.3f, 0.2f, 0.1f}};
    shape.material.glossiness = 0.9f;
    shape.material.gloss.model = model;
    shape.material.gloss.fresnel = TL_FRESNEL_CONDUCTOR;
    shape.material.gloss.index = 1;
    shape.material.gloss.extinction = 1e3f;
    return shape;
}

static void open_scene(struct test_scene *scene, int model, int side)
{
    test_scene_open_lamplit(scene, even_sheet(model), side, side);
    scene->frame.camera.eye = (vec3s){{0, 1.9f, 0.9f}};
    scene->lamps[0] = test_lamp_towards((vec3s){{0.3f, 1, -0.5f}}, 3);
}

static void fold(struct tl_shading_params *shading, int precision, float ambient)
{
    shading->reflectance = TL_REFLECTANCE_TABLE;
    shading->table_terms = TL_TERMS_ALL;
    shading->table_precision = precision;
    shading->ambient = ambient;
}

/* A3. Ambient, diffuse and gloss from one look-up, and of each colour its own table. On a ball that is half
 * in the dark no gloss hides what is missing of the rest. */
static void one_table_holds_all_light(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    for (int model = TL_REFLECT_PHONG; model <= TL_REFLECT_COSINE_LOBE; model++)
        for (int precision = 0; precision <= TL_PRECISION_FLOAT; precision++) {
            open_scene(&scene, model, 96);
            fold(&scene.settings.shading, precision, 0);
            assert_near_formula(device, &scene, models[model]);
            scene.shapes[0].material.diffuse = (vec3s){{0.8f, 0.1f, 0.4f}};
            test_scene_refresh(&scene);
            assert_near_formula(device, &scene, "another colour");
            scene.settings.shading.ambient = 0.2f;
            assert_near_formula(device, &scene, "under ambient light");
            test_scene_close(&scene);
        }
}

/* The picture of tables of gloss, to which the diffuse light is added. */
static void assert_near_gloss(struct test_device *device, struct test_scene *scene, const char *what)
{
    tl_image all = test_scene_draw(scene, device->renderer);
    scene->settings.shading.table_terms = TL_TERMS_GLOSS;
    struct test_difference off = test_scene_error(scene, device->renderer, &all);
    scene->settings.shading.table_terms = TL_TERMS_ALL;
    double bound = folded_bound(scene) / test_brightest(&all) + 1e-5;
    print_message("%-10s both tables differ by %.1e of the peak (bound %.1e)\n", what, off.largest, bound);
    assert_true(off.largest < bound);
    tl_image_release(&all);
}

/* Under every layer and in every shadow ambient light is what surfaces would emit in its place. */
static void assert_as_emitted(struct test_device *device, struct test_scene *scene)
{
    struct tl_shading_params *shading = &scene->settings.shading;
    shading->reflectance = TL_REFLECTANCE_DIRECT;
    tl_image ambient = test_scene_draw(scene, device->renderer);
    for (size_t i = 0; i < scene->shape_count; i++)
        scene->shapes[i].material.emission =
            glms_vec3_mul(tl_table_ambient(&scene->shapes[i].material, shading), scene->lamps[0].irradiance);
    shading->ambient = 0;
    test_scene_refresh(scene);
    struct test_difference off = test_scene_error(scene, device->renderer, &ambient);
    print_message("ambient light and the same emitted differ by %.1e of the peak\n", off.largest);
    assert_true(off.largest < 1e-5);
    tl_image_release(&ambient);
}

/* A3. On a matt ball that is half in the dark no gloss hides what is missing of the rest; under a coat, which
 * takes its share of both; and in a shadow, which takes none of the ambient light. */
static void shadows_leave_ambient_light(void **state)
{
    struct test_device *device = *state;
    struct test_scene scene;
    struct test_shape ball = test_sphere((vec3s){{0, 0, 0}}, 0.7f, 96);
    struct test_shape roof =
        test_square((vec3s){{-0.6f, 0.7f, 0.8f}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 1, 0}}, 0.3f, 8);
    struct test_shape sheet = even_sheet(TL_REFLECT_PHONG);
    ball.material = sheet.material;
    test_shape_release(&sheet);
    ball.material.specular = (vec3s){{0, 0, 0}};
    roof.material = ball.material;
    test_scene_open_lamplit(&scene, ball, 96, 96);
    fold(&scene.settings.shading, TL_PRECISION_FIXED8, 0.3f);
    assert_near_formula(device, &scene, "a matt ball");
    scene.shapes[0].material.coat = 0.5f;
    test_scene_add(&scene, roof);
    test_scene_refresh(&scene);
    scene.settings.shading.frequency = TL_FREQUENCY_GOURAUD;
    assert_near_gloss(device, &scene, "Gouraud");
    scene.settings.shading.frequency = TL_FREQUENCY_PHONG;
    scene.settings.light.method = TL_METHOD_PEM;
    test_scene_use_rays(&scene, 6, 1);
    assert_near_gloss(device, &scene, "shadow");
    assert_as_emitted(device, &scene);
    test_scene_close(&scene);
}

enum { SIDE = 48 };
static uint8_t texels[2 * 2 * 3] = {250, 20, 20, 20, 250, 20, 20, 20, 250, 128, 128, 255};
static tl_image picture;
static tl_weave weave;

static void stay_even(tl_material *material)
{
    material->coat = 0.3f;
}
static void colour(tl_material *material)
{
    material->diffuse_map.image = &picture;
}
static void shine(tl_material *material)
{
    material->specular_map.image = &picture;
}
static void darken(tl_material *material)
{
    material->occlusion_map.image = &picture;
}
static void bump(tl_material *material)
{
    material->normal_map.image = &picture;
}
static void interlace(tl_material *material)
{
    material->weave = &weave;
}
static void hem(tl_material *material)
{
    material->construction.hem = TL_HEM_TOPSTITCHED;
}
static void line(tl_material *material)
{
    material->back = (struct tl_back){true, {{0.1f, 0.2f, 0.3f}}, {{0, 0, 0}}};
}
static void roughen(tl_material *material)
{
    material->diffuse_roughness = 0.3f;
}
static void factor(tl_material *material)
{
    material->gloss.model = TL_REFLECT_WARD;
}

/* A part that varies from texel to texel keeps its diffuse light out of the table: the same picture to the
 * bit. */
static void uneven_parts_keep_gloss_alone(void **state)
{
    struct test_device *device = *state;
    static void (*const changes[])(tl_material *) = {stay_even, colour, shine, darken,  bump,
                                                     interlace, hem,    line,  roughen, factor};
    picture = tl_image_create(2, 2, 3, TL_IMAGE_U8);
    memcpy(tl_image_bytes(&picture), texels, sizeof texels);
    struct tl_weave_params params = *(const struct tl_weave_params *)tl_weave_options.defaults;
    params.pattern = TL_WEAVE_PLAIN;
    assert_true(tl_weave_create(&params, &weave));
    for (size_t i = 0; i < TL_COUNT(changes); i++) {
        struct test_scene scene;
        open_scene(&scene, TL_REFLECT_PHONG, SIDE);
        scene.shapes[0].material.gloss.fresnel =
            TL_FRESNEL_SCHLICK; /* by which the two kinds of table differ */
        scene.shapes[0].material.diffuse = (vec3s){{0, 0, 0}};
        changes[i](&scene.shapes[0].material);
        test_scene_refresh(&scene);
        fold(&scene.settings.shading, TL_PRECISION_FLOAT, 0);
        tl_image all = test_scene_draw(&scene, device->renderer);
        scene.settings.shading.table_terms = TL_TERMS_GLOSS;
        tl_image gloss = test_scene_draw(&scene, device->renderer);
        const char *refusal = tl_table_terms_refusal(&scene.shapes[0].material);
        print_message("%s\n", refusal ? refusal : "even");
        assert_int_equal(!refusal, i == 0);
        assert_int_equal(memcmp(all.texels, gloss.texels, (size_t)SIDE * SIDE * 16) == 0, i != 0);
        tl_image_release(&all);
        tl_image_release(&gloss);
        test_scene_close(&scene);
    }
    tl_image_release(&picture);
    tl_weave_release(&weave);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_table_holds_all_light),
        cmocka_unit_test(shadows_leave_ambient_light),
        cmocka_unit_test(uneven_parts_keep_gloss_alone),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
