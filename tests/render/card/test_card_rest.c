/* Images at rest that the graphics card draws, against the ray-traced reference and closed forms: the same
 * mean light whatever the material; noise that falls with the rounds; the same bytes twice, all rounds at
 * once or one a frame, and whatever was drawn before; the CPU's bytes where the card does not draw. */
#include "tests/render/drawn_scene.h"

#include "config/base/memory.h"

#include "tests/testing.h"

#include <stdlib.h>
#include <string.h>

#define WIDTH  40
#define HEIGHT 36
#define SHIFTS TL_FRAME_SHIFTS /* rounds of one of light.rounds */

/* ---- Editors ---- */

static void blinn_phong(struct drawn_scene *drawn)
{
    be_glossy(drawn);
    drawn_scene_cloth(drawn)->gloss.model = TL_REFLECT_BLINN_PHONG;
}

static void have_a_coat(struct drawn_scene *drawn)
{
    be_fuzzy(drawn);
    drawn_scene_cloth(drawn)->coat = 0.8f;
    drawn_scene_cloth(drawn)->coat_glossiness = 0.95f;
}

static void be_rough(struct drawn_scene *drawn)
{
    for (int i = 0; i < 2; i++)
        drawn->scene.shapes[i].material.diffuse_roughness = 0.7f;
}

static void be_threads(struct drawn_scene *drawn)
{
    be_glossy(drawn);
    drawn_scene_cloth(drawn)->gloss.model = TL_REFLECT_BANKS;
}

static void turn(struct drawn_scene *drawn)
{
    be_satin(drawn);
    drawn->scene.frame.environment_yaw = 1;
}

static void have_no_bounces(struct drawn_scene *drawn)
{
    be_matt(drawn);
    drawn->scene.settings.light.bounce = TL_BOUNCE_OFF;
}

static void bounce_once(struct drawn_scene *drawn)
{
    be_matt(drawn);
    drawn->scene.settings.light.bounce = TL_BOUNCE_ONE;
}

/* One far away, one near and below the sheet, both with shadows. */
static void have_lamps(struct drawn_scene *drawn)
{
    be_glossy(drawn);
    drawn->scene.lamps[0] = test_lamp_towards((vec3s){{-0.5f, 1, 0.3f}}, 2);
    drawn->scene.lamps[1] = test_lamp_at((vec3s){{0.7f, 0.4f, 0.6f}}, 0.3f);
    drawn->scene.frame.lamp_count = 2;
}

static void have_lamps_and_voile(struct drawn_scene *drawn)
{
    have_lamps(drawn);
    be_voile(drawn);
}

/* They show the lit scene. */
static void be_mirrors(struct drawn_scene *drawn)
{
    be_glossy(drawn);
    drawn_scene_cloth(drawn)->glossiness = 0.98f;
    drawn_scene_cloth(drawn)->specular = (vec3s){{0.5f, 0.5f, 0.5f}};
}

/* ---- Drawing ---- */

static void open_small(struct drawn_scene *drawn)
{
    drawn_scene_open(drawn, WIDTH, HEIGHT);
    struct test_shape *shapes = drawn->scene.shapes;
    for (int i = 0; i < 2; i++)
        test_shape_release(&shapes[i]);
    shapes[0] = test_sphere((vec3s){{0, 0.63f, 0}}, 0.38f, 24); /* it touches the sheet */
    shapes[1] = test_sheet(1, 0.55f, 0.07f, 2, 24);
    struct tl_render_settings *settings = &drawn->plain.settings;
    settings->light.bounce = TL_BOUNCE_ALL;
    settings->light.ratio_at = TL_RATIO_AT_SAMPLES;
    settings->light.device = TL_DEVICE_CARD;
    settings->image.supersample = 2;
    settings->reference.bounces = 3;
    settings->reference.strata = 64;
    settings->reference.lobe_samples = settings->reference.bounce_samples = 2;
}

static tl_image draw_anew(tl_renderer *renderer, struct drawn_scene *drawn)
{
    tl_error error = {0};
    assert_ok(tl_renderer_forget_scene(renderer, &error), error);
    return test_scene_draw(&drawn->scene, renderer);
}

static tl_image draw_reference(tl_renderer *renderer, struct drawn_scene *drawn, int replicates)
{
    const int method = drawn->scene.settings.light.method;
    drawn->scene.settings.light.method = TL_METHOD_REFERENCE;
    drawn->scene.settings.reference.replicates = replicates;
    tl_image image = test_scene_draw(&drawn->scene, renderer);
    drawn->scene.settings.light.method = method;
    return image;
}

/* The light of all pixels, by channel. */
static vec3s light_of(const tl_image *image)
{
    double sums[3] = {0};
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        for (size_t c = 0; c < 3; c++)
            sums[c] += (double)tl_image_floats(image)[4 * i + c];
    return (vec3s){{(float)sums[0], (float)sums[1], (float)sums[2]}};
}

/* The largest relative difference of the light of all pixels. */
static double light_difference(const tl_image *made, const tl_image *expected)
{
    const vec3s a = light_of(made), b = light_of(expected);
    double largest = 0;
    for (int c = 0; c < 3; c++)
        largest = fmax(largest, fabs((double)(a.raw[c] / b.raw[c] - 1)));
    return largest;
}

/* ---- Pictures ---- */

/* Light, by the mean of all pixels; and every pixel, against the reference. Both are noise, and edges, where
 * places of 16 samples and of 4 differ. What stands here is up to twice what came out; with larger
 * pictures and more rounds means agree within 0.0012. */
struct rest_case {
    const char *name;
    editor *edit;
    int rounds, replicates;
    double light, rmse;
};

static const struct rest_case cases[] = {
    {"matt, one bounce", bounce_once, 1, 1, 0.012, 0.12},
    {"matt, no bounces", have_no_bounces, 1, 1, 0.012, 0.12},
    {"glossy", be_glossy, 1, 1, 0.012, 0.15},
    {"Ward, light turned", turn, 1, 1, 0.012, 0.12},
    {"GGX facets", have_ggx_facets, 1, 1, 0.012, 0.12},
    {"Blinn and Phong", blinn_phong, 1, 1, 0.012, 0.15},
    {"weave, LEAN", be_woven, 1, 1, 0.012, 0.12},
    {"maps", be_mapped, 1, 1, 0.012, 0.15},
    {"coat on fuzz", have_a_coat, 1, 1, 0.012, 0.15},
    {"rough", be_rough, 1, 1, 0.012, 0.12},
    {"Banks's threads", be_threads, 1, 1, 0.012, 0.12},
    {"emission", glow, 1, 1, 0.012, 0.15},
    {"mirrors", be_mirrors, 1, 1, 0.012, 0.2},
    {"lamps", have_lamps, 1, 1, 0.012, 0.15},
    {"holes", have_holes, 1, 1, 0.012, 0.15},
    {"open", be_open, 1, 1, 0.012, 0.15},
    {"transmission", transmit, 1, 1, 0.012, 0.15},
    {"lamps through voile", have_lamps_and_voile, 1, 1, 0.012, 0.15},
    {"voile, converged", be_voile, 4, 8, 0.005, 0.06},
    {"threads, converged", have_threads, 4, 8, 0.005, 0.06},
};

static bool check_picture(tl_renderer *renderer, struct drawn_scene *drawn, const struct rest_case *item)
{
    drawn_scene_edit(drawn, item->edit);
    drawn->scene.settings.light.rounds = item->rounds;
    tl_image made = draw_anew(renderer, drawn);
    drawn_scene_expect_device(renderer, drawn, "the graphics card, by");
    tl_image expected = draw_reference(renderer, drawn, item->replicates);
    const double light = light_difference(&made, &expected);
    const struct test_difference difference = test_compare(&made, &expected);
    printf("%-22s light off by %.4f, rel. RMSE %.4f\n", item->name, light, difference.rel_rmse);
    tl_image_release(&made);
    tl_image_release(&expected);
    return light < item->light && difference.rel_rmse < item->rmse && difference.pixels > WIDTH * HEIGHT / 8;
}

static void test_pictures(void **state)
{
    const struct test_device *device = *state;
    struct drawn_scene drawn;
    int faulty = 0;
    open_small(&drawn);
    for (size_t i = 0; i < TL_COUNT(cases); i++)
        if (!check_picture(device->renderer, &drawn, &cases[i])) {
            print_error("%s: another picture than the reference's\n", cases[i].name);
            faulty++;
        }
    drawn_scene_close(&drawn);
    assert_int_equal(faulty, 0);
}

/* ---- Closed forms ---- */

/* In even light of 1 a matt ball sends its albedo from every point, whatever directions are chosen. Its
 * horizon is that of the interpolated normal: near the outline facets hide some of what lies above that. */
static void test_even_light(void **state)
{
    const struct test_device *device = *state;
    struct test_scene scene;
    struct drawn_scene settings;
    open_small(&settings);
    test_scene_open(&scene, test_environment(64, 32, test_white), (vec3s){{0, 0, 3}}, (vec3s){{0, 0, 0}}, 25,
                    40, 40);
    scene.settings = settings.plain.settings;
    drawn_scene_close(&settings);
    scene.settings.image.width = scene.settings.image.height = 40;
    scene.settings.image.ground = false;
    tl_material *material = test_scene_add(&scene, test_sphere((vec3s){{0, 0, 0}}, 0.5f, 96));
    material->diffuse = (vec3s){{0.8f, 0.5f, 0.25f}};
    material->specular = (vec3s){{0, 0, 0}};
    test_scene_refresh(&scene);
    scene.frame.still = true;
    tl_image image = test_scene_draw(&scene, device->renderer);
    double cover = 0;
    for (int i = 0; i < 40 * 40; i++)
        cover += (double)tl_image_floats(&image)[4 * i + 3];
    const vec3s light = light_of(&image);
    assert_true(cover > 500);
    for (int c = 0; c < 3; c++)
        assert_near((double)light.raw[c] / cover, (double)material->diffuse.raw[c],
                    0.002 * (double)material->diffuse.raw[c]);
    tl_image_release(&image);
    test_scene_close(&scene);
}

/* Inside a matt ball that glows by 1, light is the series of its albedo, a term a bounce: three, as
 * open_small asks for. Paths that are followed by chance stand for those that are not. */
static void test_furnace(void **state)
{
    const struct test_device *device = *state;
    struct test_scene scene;
    struct drawn_scene settings;
    const float albedo = 0.3f;
    open_small(&settings);
    test_scene_open(&scene, test_environment(64, 32, test_white), (vec3s){{0, 0, 0.1f}}, (vec3s){{0, 0, 0}},
                    60, WIDTH, WIDTH);
    const int side = scene.settings.image.width;
    scene.settings = settings.plain.settings;
    drawn_scene_close(&settings);
    scene.settings.image.width = scene.settings.image.height = side;
    scene.settings.image.ground = false;
    tl_material *material = test_scene_add(&scene, test_sphere((vec3s){{0, 0, 0}}, 0.5f, 48));
    material->double_sided = true;
    material->diffuse = (vec3s){{albedo, albedo, albedo}};
    material->specular = (vec3s){{0, 0, 0}};
    material->emission = (vec3s){{1, 1, 1}};
    test_scene_refresh(&scene);
    scene.frame.still = true;
    char said[160];
    tl_renderer_describe_device(device->renderer, &scene.frame, &scene.settings, said, sizeof said);
    assert_non_null(strstr(said, "the graphics card, by"));
    tl_image image = test_scene_draw(&scene, device->renderer);
    const double light = (double)light_of(&image).x / (side * side);
    const double expected = (1 - pow((double)albedo, 4)) / (1 - (double)albedo);
    printf("light in the furnace %.4f, expected %.4f\n", light, expected);
    assert_near(light, expected, 0.01);
    tl_image_release(&image);
    test_scene_close(&scene);
}

/* ---- Rounds ---- */

/* Draws frame after frame, each with one more round, from `from` rounds to `to`. */
static tl_image draw_rounds(tl_renderer *renderer, struct drawn_scene *drawn, int from, int to)
{
    tl_image image = {0};
    drawn->scene.frame.still = false;
    drawn->scene.frame.smooth = true;
    for (int i = from; i < to; i++) {
        tl_image_release(&image);
        image = test_scene_draw(&drawn->scene, renderer);
    }
    drawn->scene.frame.smooth = false;
    return image;
}

/* The mean of n rounds is off by noise / sqrt(n), so four times as many have half of it. The rounds are not
 * wholly independent: sequences fall faster. */
static void test_noise_falls(void **state)
{
    enum { ROUNDS = 64 };
    tl_renderer *renderer = ((const struct test_device *)*state)->renderer;
    struct drawn_scene drawn;
    open_small(&drawn);
    drawn_scene_edit(&drawn, be_satin);
    drawn.scene.settings.light.rounds = ROUNDS / SHIFTS;
    tl_image last = draw_anew(renderer, &drawn);
    tl_renderer_forget(renderer);
    double off[2];
    for (int i = 0, rounds = 0; i < 2; i++) {
        static const int counts[] = {4, 16};
        tl_image image = draw_rounds(renderer, &drawn, rounds, counts[i]);
        rounds = counts[i];
        off[i] = test_compare(&image, &last).rel_rmse;
        tl_image_release(&image);
        assert_false(tl_renderer_is_at_rest(renderer));
    }
    printf("rel. RMSE after 4, 16 rounds: %.4f, %.4f\n", off[0], off[1]);
    assert_in_range((int)(100 * off[0] / off[1]), 160, 320);
    tl_image_release(&last);
    drawn_scene_close(&drawn);
}

/* The same bytes twice; all rounds at once or one a frame; rounds begin again when something changes. */
static void test_rounds_repeat(void **state)
{
    tl_renderer *renderer = ((const struct test_device *)*state)->renderer;
    struct drawn_scene drawn;
    open_small(&drawn);
    drawn_scene_edit(&drawn, have_threads);
    tl_image first = draw_anew(renderer, &drawn);
    assert_true(tl_renderer_is_at_rest(renderer));
    tl_renderer_forget(renderer);
    const vec3s eye = drawn.scene.frame.camera.eye;
    drawn.scene.frame.camera.eye.x += 0.1f;
    tl_image other = draw_rounds(renderer, &drawn, 0, 3);
    tl_image_release(&other);
    drawn.scene.frame.camera.eye = eye;
    drawn.scene.settings.light.ratio_at = TL_RATIO_AT_VERTICES; /* a frame of the motion */
    other = draw_rounds(renderer, &drawn, 0, 1);
    tl_image_release(&other);
    drawn.scene.settings.light.ratio_at = TL_RATIO_AT_SAMPLES;
    other = draw_rounds(renderer, &drawn, 0, SHIFTS - 1);
    assert_false(tl_renderer_is_at_rest(renderer));
    assert_memory_not_equal(other.texels, first.texels, (size_t)16 * WIDTH * HEIGHT);
    tl_image_release(&other);
    other = draw_rounds(renderer, &drawn, 0, 1);
    assert_true(tl_renderer_is_at_rest(renderer));
    drawn_scene_expect_same(&other, &first);
    tl_image_release(&other);
    other = draw_rounds(renderer, &drawn, 0, 1); /* nothing is drawn any more */
    drawn_scene_expect_same(&other, &first);
    tl_image_release(&other);
    tl_image_release(&first);
    drawn_scene_close(&drawn);
}

/* Frames in motion do not see what rounds have left. */
static void test_motion_goes_on(void **state)
{
    tl_renderer *renderer = ((const struct test_device *)*state)->renderer;
    struct drawn_scene drawn;
    open_small(&drawn);
    drawn_scene_edit(&drawn, be_satin);
    drawn.scene.settings.light.bounce = TL_BOUNCE_OFF; /* it depends on earlier frames */
    drawn.scene.frame.still = false;
    drawn.scene.settings.light.ratio_at = TL_RATIO_AT_VERTICES;
    tl_image first = draw_anew(renderer, &drawn);
    drawn.scene.settings.light.ratio_at = TL_RATIO_AT_SAMPLES;
    tl_image other = draw_rounds(renderer, &drawn, 0, 5);
    tl_image_release(&other);
    drawn.scene.settings.light.ratio_at = TL_RATIO_AT_VERTICES;
    other = test_scene_draw(&drawn.scene, renderer);
    drawn_scene_expect_same(&other, &first);
    tl_image_release(&other);
    tl_image_release(&first);
    drawn_scene_close(&drawn);
}

/* ---- What the card does not draw ---- */

static void have_dark_mirrors(struct drawn_scene *drawn)
{
    be_mirrors(drawn);
    drawn_scene_cloth(drawn)->glossiness = 0.999f;
    drawn->scene.settings.light.bounce = TL_BOUNCE_OFF;
}

/* A frame of a flight: the camera moves on, and no round follows. */
static void be_moving(struct drawn_scene *drawn)
{
    drawn->scene.frame.still = false;
}

static void test_refusals(void **state)
{
    static const struct {
        editor *edit;
        const char *text;
    } refused[] = {{have_dark_mirrors, "near mirrors of a scene whose light does not bounce"},
                   {be_moving, "images of one round"}};
    const struct test_device *device = *state;
    struct drawn_scene drawn;
    open_small(&drawn);
    for (size_t i = 0; i < TL_COUNT(refused); i++) {
        drawn_scene_edit(&drawn, refused[i].edit);
        drawn_scene_expect_device(device->renderer, &drawn, refused[i].text);
        tl_image instead = draw_anew(device->renderer, &drawn);
        drawn.scene.settings.light.device = TL_DEVICE_CPU;
        tl_image expected = draw_anew(device->renderer, &drawn);
        drawn_scene_expect_same(&instead, &expected);
        tl_image_release(&expected);
        tl_image_release(&instead);
    }
    drawn_scene_close(&drawn);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures),      cmocka_unit_test(test_even_light),
        cmocka_unit_test(test_furnace),       cmocka_unit_test(test_noise_falls),
        cmocka_unit_test(test_rounds_repeat), cmocka_unit_test(test_motion_goes_on),
        cmocka_unit_test(test_refusals)};
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
