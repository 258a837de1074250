/* Light that bounces, in the reference, against closed forms: inside a closed sphere, before a shining wall,
 * and under a sky that is a shining sphere. Every result must be within 0.3 % of its formula, and three
 * standard errors must be less than that. */
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/reference/reference.h"

#include "tests/testing.h"

#define EXACTNESS 3e-3
#define SIZE      16 /* pixels a side */

static const vec3s origin = {{0, 0, 0}}, x_axis = {{1, 0, 0}}, y_axis = {{0, 1, 0}}, z_axis = {{0, 0, 1}};

static struct test_scene *scene_new(test_radiance *sky, vec3s eye, vec3s target, float fov_deg)
{
    struct test_scene *scene = TL_NEW(struct test_scene);
    test_scene_open(scene, test_environment(16, 8, sky), eye, target, fov_deg, SIZE, SIZE);
    if (eye.x == target.x && eye.z == target.z)
        scene->frame.camera.up = (vec3s){{0, 0, -1}};
    scene->settings.image.supersample = 1;
    scene->settings.light.reflect_scene = false;
    scene->settings.light.lobe = TL_LOBE_DUAL;
    scene->settings.reference.strata = 2048;
    scene->settings.reference.lobe_samples = 32;
    scene->settings.reference.bounce_samples = 128;
    scene->settings.reference.replicates = 4;
    return scene;
}

static tl_material *scene_add(struct test_scene *scene, struct test_shape shape, float albedo)
{
    tl_material *material = test_scene_add(scene, shape);
    material->diffuse = (vec3s){{albedo, albedo, albedo}};
    material->specular = (vec3s){{0, 0, 0}};
    return material;
}

static void scene_free(struct test_scene *scene)
{
    test_scene_close(scene);
    free(scene);
}

static tl_image draw(struct test_scene *scene, int bounces, struct tl_reference_report *report)
{
    tl_error error = {0};
    tl_image image;
    test_scene_refresh(scene);
    scene->settings.light.bounce = bounces == 0 ? TL_BOUNCE_OFF : TL_BOUNCE_ALL;
    scene->settings.reference.bounces = bounces;
    const struct tl_reference_request request =
        tl_frame_reference_request(&scene->frame, &scene->settings, NULL);
    assert_ok(tl_reference_draw(&request, &image, report, &error), error);
    return image;
}

/* The mean of the image before the sky, by channel. `error`, if not NULL: its relative standard error, at
 * most. */
static vec3s mean_of(struct test_scene *scene, int bounces, double *error)
{
    struct tl_reference_report report;
    tl_image image = draw(scene, bounces, &report);
    double sums[3] = {0}, sky = (double)tl_image_floats(&scene->environment.image)[0];
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float *pixel = test_pixel(&image, i % SIZE, i / SIZE);
        for (int c = 0; c < 3; c++)
            sums[c] += ((double)pixel[c] + (1 - (double)pixel[3]) * sky) / (SIZE * SIZE);
    }
    tl_image_release(&image);
    if (error)
        *error = report.standard_error / SIZE; /* each pixel has its own paths */
    return (vec3s){{(float)sums[0], (float)sums[1], (float)sums[2]}};
}

static void check(const char *what, double got, double expected, double error)
{
    printf("%s: expected %.5f, drawn %.5f, off by %+.3f %%, standard error %.3f %%\n", what, expected, got,
           100 * (got / expected - 1), 100 * error);
    assert_true(3 * error <= EXACTNESS);
    assert_near(got, expected, EXACTNESS * expected);
}

/* A closed sphere that shines with 1 all over: n bounces add up 1 + a + ... + a^n, in each channel its own.
 */
static void test_shining_sphere(void **state)
{
    (void)state;
    const float albedos[2][3] = {{0.8f, 0.5f, 0.1f}, {0.2f, 0.15f, 0.1f}}; /* by chance, dark paths end */
    for (int i = 0; i < 6; i++) {
        const int bounces = 2 * (i % 3);
        const float *albedo = albedos[i / 3];
        struct test_scene *scene = scene_new(test_black, origin, x_axis, 40);
        scene->settings.reference.bounce_samples = 8; /* all see the same */
        tl_material *material = scene_add(scene, test_sphere(origin, 1, 64), 0);
        material->diffuse = (vec3s){{albedo[0], albedo[1], albedo[2]}};
        material->emission = (vec3s){{1, 1, 1}};
        double error;
        vec3s got = mean_of(scene, bounces, &error);
        for (int c = 0; c < 3; c++) {
            double expected = 0;
            for (int k = 0; k <= bounces; k++)
                expected += pow((double)albedo[c], k);
            check("shining sphere", (double)got.raw[c], expected, error);
        }
        scene_free(scene);
    }
}

/* The integrating sphere: after the first bounce its light is the same everywhere, wherever the lamp is. A
 * lamp of intensity I in a sphere of radius r: the flux 4 pi I lands on 4 pi r^2, and bounce n adds a^(n + 1)
 * I / (pi r^2) to the radiance. */
static void test_integrating_sphere(void **state)
{
    (void)state;
    const float albedo = 0.7f, radius = 2, intensity = 3;
    struct test_scene *scene = scene_new(test_black, origin, x_axis, 50);
    scene_add(scene, test_sphere(origin, radius, 128), albedo);
    scene->lamps[0] = (struct tl_lamp){.kind = TL_LAMP_POINT,
                                       .position = {{-0.6f, 0.3f, 0.2f}},
                                       .irradiance = {{intensity, intensity, intensity}}};
    scene->frame.lamp_count = 1;
    double before = (double)mean_of(scene, 0, NULL).y;
    for (int bounce = 1; bounce <= 3; bounce++) {
        double error, now = (double)mean_of(scene, bounce, &error).y;
        double expected =
            pow((double)albedo, bounce + 1) * (double)intensity / (M_PI * (double)(radius * radius));
        check("integrating sphere", now, before + expected, error);
        assert_near(now - before, expected, 0.01 * expected);
        before = now;
    }
    scene_free(scene);
}

/* Share of a plane's cosine-weighted hemisphere that an upright wall takes, `height` high and `width` wide to
 * one side, at a distance of `a` [Howell, B-5]. */
static double wall_factor(double a, double height, double width)
{
    double slant = hypot(a, height);
    return (atan2(width, a) - a / slant * atan2(width, slant)) / (2 * M_PI);
}

/* Two plates at right angles: a matt one before a red wall that shines. */
static void test_two_plates(void **state)
{
    (void)state;
    const float distance = 0.5f, half = 2;
    struct test_scene *scene =
        scene_new(test_black, (vec3s){{distance, 0.5f, 0}}, (vec3s){{distance, 0, 0}}, 0.5f);
    scene_add(scene, test_square(origin, x_axis, y_axis, half, 1), 0.5f);
    tl_material *wall = scene_add(scene, test_square((vec3s){{0, 1 - half, 0}}, z_axis, x_axis, half, 1), 0);
    wall->emission = (vec3s){{1, 0, 0}};
    scene->settings.reference.bounce_samples = 8192;
    double error;
    vec3s got = mean_of(scene, 1, &error);
    check("plates", (double)got.x, 0.5 * 2 * wall_factor((double)distance, 1, (double)half), error);
    assert_near(got.y, 0, 0);
    assert_near(mean_of(scene, 0, NULL).x, 0, 0);
    scene_free(scene);
}

/* ---- A shining sphere instead of the sky ---- */

static void make_gloss(tl_material *material)
{
    material->glossiness = 0.6f;
    material->specular = (vec3s){{0.3f, 0.3f, 0.3f}};
}

static void make_ward(tl_material *material)
{
    make_gloss(material);
    material->gloss.model = TL_REFLECT_WARD;
    material->gloss.width_weft = 0.2f;
    material->gloss.width_warp = 0.4f;
}

static void make_coated(tl_material *material)
{
    make_gloss(material);
    material->coat = 0.8f;
    material->coat_glossiness = 0.7f;
}

static void make_fuzzy(tl_material *material)
{
    material->fuzz = (struct tl_fuzz){.colour = {{0.5f, 0.5f, 0.5f}}, .roughness = 0.5f};
}

static void make_rough(tl_material *material)
{
    material->diffuse_roughness = 0.5f;
}

static void make_threads(tl_material *material)
{
    material->gloss.model = TL_REFLECT_BANKS;
}

static void make_sheer(tl_material *material)
{
    material->transmission = (vec3s){{0.4f, 0.4f, 0.4f}};
    material->openness = 0.3f;
}

/* A slanted square under a sheet of open cloth, in white surroundings. */
static struct test_scene *slanted_scene(test_radiance *sky, void (*make)(tl_material *))
{
    struct test_scene *scene = scene_new(sky, (vec3s){{0, 0.6f, 1.5f}}, origin, 8);
    make(scene_add(scene, test_square(origin, x_axis, y_axis, 0.4f, 1), 0.5f));
    tl_material *veil =
        scene_add(scene, test_square((vec3s){{0, 0.15f, -0.3f}}, x_axis, y_axis, 0.25f, 1), 0.6f);
    veil->openness = 0.4f;
    return scene;
}

/* A sky of radiance 1 and a closed sphere that shines with 1 light everything alike, every lobe in it: what
 * the one sends in n bounces, the other does in n + 1. So the paths of each lobe are held against the
 * sampling of the environment; n is 1, which has what 0 sends, too, and for the first lobe 0. */
static void test_sphere_for_sky(void **state)
{
    (void)state;
    const struct {
        const char *name;
        void (*make)(tl_material *);
    } cases[] = {{"gloss", make_gloss}, {"ward", make_ward},   {"coat", make_coated},
                 {"fuzz", make_fuzzy},  {"rough", make_rough}, {"threads", make_threads},
                 {"sheer", make_sheer}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        struct test_scene *open = slanted_scene(test_white, cases[i].make);
        struct test_scene *closed = slanted_scene(test_black, cases[i].make);
        scene_add(closed, test_sphere(origin, 5, 32), 0)->emission = (vec3s){{1, 1, 1}};
        for (int bounces = i > 0; bounces < 2; bounces++) {
            double error;
            double expected = (double)mean_of(open, bounces, NULL).y;
            double got = (double)mean_of(closed, bounces + 1, &error).y;
            check(cases[i].name, got, expected, error);
        }
        scene_free(open);
        scene_free(closed);
    }
}

/* A matt white fold in white light: the more bounces, the nearer it comes to white, and never beyond. */
static void test_white_fold(void **state)
{
    (void)state;
    struct test_scene *scene = scene_new(test_white, (vec3s){{0.3f, 0.9f, 0}}, origin, 20);
    scene_add(scene, test_square(origin, x_axis, y_axis, 1, 1), 1);
    scene_add(scene, test_square(origin, y_axis, x_axis, 1, 1), 1);
    double last = 0;
    for (int bounces = 0; bounces <= 8; bounces += bounces < 2 ? 1 : 6) {
        double now = (double)mean_of(scene, bounces, NULL).y;
        printf("white fold: %d bounces, radiance %.4f\n", bounces, now);
        assert_true(now > last && now < 1.001);
        last = now;
    }
    assert_near(last, 1, 5e-3);
    scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shining_sphere), cmocka_unit_test(test_integrating_sphere),
        cmocka_unit_test(test_two_plates),     cmocka_unit_test(test_sphere_for_sky),
        cmocka_unit_test(test_white_fold),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
