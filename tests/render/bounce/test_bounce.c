/* Bounced light as drawn against the reference's: a waved sheet before a red wall, of several materials, lit
 * by a sky at samples and at vertices; and by a wall that shines, by a lamp, over the ground. References are
 * kept: TOILE_MAKE_REFERENCES=1 build/release/tests/render/test_bounce traces them again. */
#include "tests/render/kept_reference.h"
#include "tests/render/scenes.h"

#include "config/base/memory.h"
#include "render/reference/reference.h"

#include "tests/testing.h"

#include <string.h>

#define SIZE   40
#define CELLS  32 /* a side of the sheet: eight a wave and more */
#define ROUNDS 16

static tl_image trace_reference(struct test_scene *scene)
{
    tl_error error = {0};
    struct tl_reference_report report;
    tl_image image;
    struct tl_ground ground;
    scene->settings.reference.strata = 512;
    scene->settings.reference.replicates = 8;
    if (scene->settings.image.ground) {
        struct tl_casters casters;
        assert_ok(tl_casters_measure(scene->surfaces, scene->shape_count, &casters, &error), error);
        tl_ground_make(&casters, TL_GROUND_GREY, &ground);
    }
    const struct tl_reference_request request = tl_frame_reference_request(
        &scene->frame, &scene->settings, scene->settings.image.ground ? &ground : NULL);
    assert_ok(tl_reference_draw(&request, &image, &report, &error), error);
    assert_true(report.standard_error < 0.03);
    return image;
}

static double mean_of(const tl_image *image, int channel)
{
    double sum = 0;
    for (int i = 0; i < image->width * image->height; i++)
        sum += (double)tl_image_floats(image)[4 * i + channel];
    return sum / (image->width * image->height);
}

static void make_matt(tl_material *material)
{
    material->diffuse = (vec3s){{0.8f, 0.8f, 0.8f}};
    material->specular = (vec3s){{0, 0, 0}};
}

static void make_glossy(tl_material *material)
{
    material->diffuse = (vec3s){{0.6f, 0.6f, 0.6f}};
    material->specular = (vec3s){{0.3f, 0.3f, 0.3f}};
    material->glossiness = 0.8f;
}

static void make_ward(tl_material *material)
{
    make_glossy(material);
    material->gloss.model = TL_REFLECT_WARD;
    material->gloss.width_weft = 0.2f;
    material->gloss.width_warp = 0.35f;
}

static void make_fuzzy(tl_material *material)
{
    make_matt(material);
    material->diffuse = (vec3s){{0.5f, 0.5f, 0.5f}};
    material->fuzz = (struct tl_fuzz){.colour = {{0.6f, 0.6f, 0.6f}}, .roughness = 0.6f};
}

static void make_sheer(tl_material *material)
{
    make_matt(material);
    material->diffuse = material->transmission = (vec3s){{0.45f, 0.45f, 0.45f}};
    material->openness = 0.35f;
}

/* A waved sheet before a red wall that stands upright behind it. */
static struct test_scene *fold_scene(test_radiance *sky, void (*make)(tl_material *))
{
    struct test_scene *scene = TL_NEW(struct test_scene);
    test_scene_open(scene, test_environment(64, 32, sky), (vec3s){{0.7f, 1.2f, 1.3f}}, (vec3s){{0, 0.2f, 0}},
                    40, SIZE, SIZE);
    test_scene_use_rays(scene, 192, ROUNDS);
    scene->settings.reference.bounce_samples = 32;
    scene->frame.still = true;
    make(test_scene_add(scene, test_sheet(0.2f, 0.5f, 0.12f, 2, CELLS)));
    tl_material *wall = test_scene_add(scene, test_square((vec3s){{0, 0.55f, -0.5f}}, (vec3s){{1, 0, 0}},
                                                          (vec3s){{0, 0, 1}}, 0.5f, CELLS / 2));
    make_matt(wall);
    wall->diffuse = (vec3s){{0.8f, 0.05f, 0.05f}};
    return scene;
}

enum {
    AT_SAMPLES_ONLY = 1 << TL_RATIO_AT_SAMPLES,
    AT_VERTICES_ONLY = 1 << TL_RATIO_AT_VERTICES,
    AT_BOTH = 3
};

/* What is missing of the mean, by channel, without bounces, and what is wrong with them: at most a share
 * `bound` of it; and of the image's error. Frees the scene. */
static void check(struct test_device *device, struct test_scene *scene, const char *name, int bounce,
                  int places, double bound)
{
    char reference[64];
    snprintf(reference, sizeof reference, "bounce_%s%s", name, bounce == TL_BOUNCE_ONE ? "_one" : "");
    test_scene_refresh(scene);
    scene->settings.light.bounce = bounce;
    tl_image exact =
        kept_reference(reference, scene, scene->shapes[0].light_mesh.from ? NULL : trace_reference);
    for (int ratio_at = TL_RATIO_AT_SAMPLES; ratio_at <= TL_RATIO_AT_VERTICES; ratio_at++) {
        if (!(places & 1 << ratio_at))
            continue;
        scene->settings.light.ratio_at = ratio_at;
        scene->settings.light.bounce = TL_BOUNCE_OFF;
        tl_image off = test_scene_draw(scene, device->renderer);
        scene->settings.light.bounce = bounce;
        tl_image on = test_scene_draw(scene, device->renderer);
        double without = test_compare(&off, &exact).rel_rmse, with = test_compare(&on, &exact).rel_rmse;
        printf("%-8s %s, at %s: relative RMSE %.2f %% without, %.2f %% with; means", name,
               bounce == TL_BOUNCE_ONE ? "one" : "all",
               ratio_at == TL_RATIO_AT_VERTICES ? "vertices" : "samples", 100 * without, 100 * with);
        bool good = with < 2 * bound * without; /* it holds the noise of both */
        for (int c = 0; c < 3; c++) {
            double truth = mean_of(&exact, c), lacking = truth - mean_of(&off, c);
            double wrong = mean_of(&on, c) - truth;
            printf(" %+.2f (%+.2f)", 100 * wrong / truth, -100 * lacking / truth);
            good = good && lacking > 0 && fabs(wrong) < bound * lacking;
        }
        printf(" %%\n");
        assert_true(good);
        tl_image_release(&off);
        tl_image_release(&on);
    }
    tl_image_release(&exact);
    test_scene_close(scene);
    free(scene);
}

/* What is hit sends its gloss on as if that were matt: so less arrives than should where sheets are glossy.
 */
#define MATT   0.15
#define GLOSSY 0.33

static void test_sky(void **state)
{
    check(*state, fold_scene(test_daylight, make_matt), "matt", TL_BOUNCE_ONE, AT_BOTH, MATT);
    check(*state, fold_scene(test_daylight, make_matt), "matt", TL_BOUNCE_ALL, AT_BOTH, MATT);
    check(*state, fold_scene(test_daylight, make_glossy), "glossy", TL_BOUNCE_ALL, AT_BOTH, GLOSSY);
    check(*state, fold_scene(test_daylight, make_ward), "ward", TL_BOUNCE_ALL, AT_BOTH, GLOSSY);
    check(*state, fold_scene(test_daylight, make_fuzzy), "fuzz", TL_BOUNCE_ALL, AT_BOTH, GLOSSY);
}

/* Light passes the sheet's holes and its threads, both ways. When it did neither, voile was a fifth too dark.
 */
static void test_sheer(void **state)
{
    check(*state, fold_scene(test_daylight, make_sheer), "sheer", TL_BOUNCE_ALL, AT_BOTH, MATT);
}

/* Cloth that is drawn smoothly keeps its light at its own vertices; the others have the mean of theirs. The
 * references are those of the same cloth unsplit. */
static void test_split(void **state)
{
    struct test_scene *scene = fold_scene(test_daylight, make_matt);
    test_shape_split(&scene->shapes[0], CELLS);
    check(*state, scene, "matt", TL_BOUNCE_ALL, AT_VERTICES_ONLY, MATT);
    scene = fold_scene(test_daylight, make_sheer);
    test_shape_split(&scene->shapes[0], CELLS);
    check(*state, scene, "sheer", TL_BOUNCE_ALL, AT_BOTH, MATT);
}

static void test_shining_wall(void **state)
{
    struct test_scene *scene = fold_scene(test_black, make_matt);
    scene->settings.reference.bounce_samples = 128;
    scene->shapes[1].material.emission = (vec3s){{1, 0.5f, 0.25f}};
    check(*state, scene, "emission", TL_BOUNCE_ALL, AT_SAMPLES_ONLY, MATT);
}

static void test_lamp(void **state)
{
    struct test_scene *scene = fold_scene(test_black, make_matt);
    scene->lamps[0] = test_lamp_at((vec3s){{0.2f, 0.9f, 0.1f}}, 2);
    scene->frame.lamp_count = 1;
    check(*state, scene, "lamp", TL_BOUNCE_ALL, AT_SAMPLES_ONLY, MATT);
}

/* The lamp is between the sheet and the wall, which shadows nothing that it lights; the wall shows its own
 * back. */
static void test_lined_wall(void **state)
{
    struct test_scene *scene = fold_scene(test_daylight, make_matt);
    struct test_shape *wall = &scene->shapes[1];
    scene->settings.reference.bounce_samples = 256;
    test_shape_release(wall);
    *wall = test_square((vec3s){{0, 0.55f, -0.5f}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, -1}}, 0.5f, CELLS / 2);
    make_matt(&wall->material);
    wall->material.double_sided = true;
    wall->material.diffuse = (vec3s){{0.8f, 0.05f, 0.05f}};
    wall->material.back = (struct tl_back){.is_given = true, .diffuse = {{0.05f, 0.8f, 0.4f}}};
    scene->lamps[0] = test_lamp_at((vec3s){{0.1f, 0.6f, -0.3f}}, 1);
    scene->frame.lamp_count = 1;
    check(*state, scene, "lined", TL_BOUNCE_ALL, AT_SAMPLES_ONLY, MATT);
}

/* A lamp below the sheet lights the wall through it. */
static void test_lamp_through_cloth(void **state)
{
    struct test_scene *scene = fold_scene(test_black, make_sheer);
    scene->lamps[0] = test_lamp_at((vec3s){{0.1f, -0.4f, 0}}, 2);
    scene->frame.lamp_count = 1;
    check(*state, scene, "lamp_through", TL_BOUNCE_ALL, AT_SAMPLES_ONLY, MATT);
}

/* A glossy wall under a black roof, which keeps the sky from its gloss. */
static void test_shaded_gloss(void **state)
{
    struct test_scene *scene = fold_scene(test_daylight, make_matt);
    tl_material *wall = &scene->shapes[1].material;
    wall->diffuse = (vec3s){{0.02f, 0.02f, 0.02f}};
    wall->specular = (vec3s){{0.8f, 0.6f, 0.4f}};
    wall->gloss = (struct tl_gloss){.model = TL_REFLECT_WARD, .width_weft = 0.3f, .width_warp = 0.3f};
    tl_material *roof = test_scene_add(
        scene, test_square((vec3s){{0, 1.3f, 0.3f}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 0.7f, 4));
    roof->diffuse = roof->specular = (vec3s){{0, 0, 0}};
    check(*state, scene, "shaded_gloss", TL_BOUNCE_ALL, AT_SAMPLES_ONLY, MATT);
}

static double mean_in(struct test_device *device, struct test_scene *scene, int bounce)
{
    scene->settings.light.bounce = bounce;
    tl_image image = test_scene_draw(scene, device->renderer);
    const double mean = mean_of(&image, 0);
    tl_image_release(&image);
    return mean;
}

static void make_metal(tl_material *material)
{
    material->diffuse = (vec3s){{0, 0, 0}};
    material->specular = (vec3s){{0.8f, 0.8f, 0.8f}};
    material->glossiness = 0.6f;
}

struct lag {
    const char *name;
    void (*make)(tl_material *material);
    int shares;
    bool by_sky, jitters, hides_wall;
};

/* The fold; or the sheet alone from above, near the wall, which is of the same material and only mirrored. */
static struct test_scene *lag_scene(const struct lag *lag)
{
    struct test_scene *scene = fold_scene(lag->by_sky ? test_daylight : test_black, lag->make);
    if (lag->hides_wall) {
        lag->make(&scene->shapes[1].material);
        scene->frame.camera.eye = (vec3s){{0, 1.6f, 0.2f}};
        scene->frame.camera.target = (vec3s){{0, 0.2f, -0.2f}};
        scene->frame.camera.fov_y = glm_rad(15);
    }
    scene->lamps[0] = test_lamp_at((vec3s){{0.2f, 0.9f, 0.1f}}, 2);
    scene->frame.lamp_count = !lag->by_sky;
    return scene;
}

/* The lamp or, where there is none, the sky becomes so many times as bright. */
static void brighten(struct test_scene *scene, float times)
{
    if (scene->frame.lamp_count > 0) {
        scene->lamps[0].irradiance = glms_vec3_scale(scene->lamps[0].irradiance, times);
        return;
    }
    float *texels = tl_image_floats(&scene->environment.image);
    const int count = 3 * scene->environment.image.width * scene->environment.image.height;
    for (int i = 0; i < count; i++)
        texels[i] *= times;
    scene->frame.environment_revision += 1000;
}

/* Draws frames in which the light flickers by a thousandth, as nothing rests while something changes; returns
 * the bounced light of the last. */
static double flicker(struct test_device *device, struct test_scene *scene, int frames, double without)
{
    double mean = 0;
    for (int frame = 0; frame < frames; frame++) {
        brighten(scene, frame % 2 ? 1 / 1.001f : 1.001f);
        mean = mean_in(device, scene, TL_BOUNCE_ALL);
    }
    return mean - without;
}

/* A lamp or the sky becomes twice as bright: bounced light follows after as many frames as it takes until all
 * that is seen was renewed, and what that sees; where that is all in each, after five. Then it is as bright
 * as before, and once the image rests so is what bounces, but for second bounces: a tenth of what there was
 * more (three fourths when rounds at rest were averaged with what was found in motion). */
static void test_lag(void **state)
{
    struct test_device *device = *state;
    const struct lag lags[] = {{"matt", make_matt, 1, .jitters = true},
                               {"matt", make_matt, 8, .jitters = true},
                               {"matt", make_matt, 32, .jitters = false},
                               {"matt", make_matt, 8, .by_sky = true, .jitters = true},
                               {"metal", make_metal, 8, true, true, .hides_wall = true}};
    for (size_t i = 0; i < TL_COUNT(lags); i++) {
        const struct lag *lag = &lags[i];
        struct test_scene *scene = lag_scene(lag);
        const double direct = mean_in(device, scene, TL_BOUNCE_OFF);
        const double bounced = mean_in(device, scene, TL_BOUNCE_ALL) - direct;
        scene->frame.still = false;
        scene->settings.light.rounds = 1;
        scene->settings.light.jitter = lag->jitters;
        scene->settings.light.bounce_shares = lag->shares;
        brighten(scene, 2);
        const double soon = flicker(device, scene, 5, 2 * direct) / bounced - 1;
        const double late = flicker(device, scene, 8 * lag->shares, 2 * direct) / bounced - 1;
        brighten(scene, 0.5f);
        double rest = mean_in(device, scene, TL_BOUNCE_ALL);
        while (!tl_renderer_is_at_rest(device->renderer))
            rest = mean_in(device, scene, TL_BOUNCE_ALL);
        rest = (rest - direct) / bounced - 1;
        printf("%s by %s, one in %2d: %.2f of the change after five frames, %.2f late; at rest %+.3f of what "
               "was\n",
               lag->name, lag->by_sky ? "sky" : "lamp", lag->shares, soon, late, rest);
        assert_true(lag->shares == 1 ? soon > 0.7 : soon < 5.0 / lag->shares);
        assert_true(fabs(late - 1) < 0.1);
        assert_true(fabs(rest) < 0.15);
        test_scene_close(scene);
        free(scene);
    }
}

/* A lamp below the ground lights nothing, and nothing sends its light on. */
static void test_buried_lamp(void **state)
{
    const struct test_device *device = *state;
    struct test_scene *scene = fold_scene(test_black, make_matt);
    scene->settings.image.ground = true;
    scene->lamps[0] = test_lamp_at((vec3s){{0, -0.5f, 0}}, 2);
    scene->frame.lamp_count = 1;
    for (int bounce = TL_BOUNCE_OFF; bounce <= TL_BOUNCE_ALL; bounce++) {
        scene->settings.light.bounce = bounce;
        tl_image image = test_scene_draw(scene, device->renderer);
        assert_float_equal(test_brightest(&image), 0, 0);
        tl_image_release(&image);
    }
    test_scene_close(scene);
    free(scene);
}

/* A ball over the ground, which lights its underside. */
static void test_ground(void **state)
{
    struct test_scene *scene = TL_NEW(struct test_scene);
    test_scene_open(scene, test_environment(64, 32, test_daylight), (vec3s){{0.3f, 0.35f, 1.6f}},
                    (vec3s){{0, 0.35f, 0}}, 25, SIZE, SIZE);
    test_scene_use_rays(scene, 192, ROUNDS);
    scene->settings.reference.bounce_samples = 32;
    scene->frame.still = true;
    scene->settings.image.ground = true;
    make_matt(test_scene_add(scene, test_sphere((vec3s){{0, 0.4f, 0}}, 0.3f, 32)));
    check(*state, scene, "ground", TL_BOUNCE_ALL, AT_BOTH, MATT);
}

static void make_black(tl_material *material)
{
    material->diffuse = material->specular = (vec3s){{0, 0, 0}};
}

static enum tl_job_action bounce_action(const tl_renderer *renderer)
{
    const tl_plan *plan = tl_renderer_last_plan(renderer);
    int i = 0;
    while (strcmp(plan->rows[i].name, "bounce") != 0)
        i++;
    return plan->rows[i].action;
}

/* Black cloth sends nothing on, and the job does not run. With the inside of the closed ball white it does,
 * though nobody sees the inside and no ray meets it: its output changes no bit. Under a coat it runs as well.
 */
static void test_black_cloth(void **state)
{
    const struct test_device *device = *state;
    struct test_scene *scene = TL_NEW(struct test_scene);
    tl_image dropped, made;
    test_scene_open(scene, test_environment(64, 32, test_daylight), (vec3s){{0.3f, 0.35f, 1.6f}},
                    (vec3s){{0, 0.35f, 0}}, 25, SIZE, SIZE);
    test_scene_use_rays(scene, 48, 1);
    scene->settings.light.bounce = TL_BOUNCE_ALL;
    tl_material *ball = test_scene_add(scene, test_sphere((vec3s){{0, 0.4f, 0}}, 0.3f, 32));
    make_black(ball);
    test_scene_refresh(scene);
    dropped = test_scene_draw(scene, device->renderer);
    assert_int_equal(bounce_action(device->renderer), TL_JOB_DROP);
    ball->back = (struct tl_back){.is_given = true, .diffuse = {{1, 1, 1}}};
    test_scene_refresh(scene);
    made = test_scene_draw(scene, device->renderer);
    assert_int_equal(bounce_action(device->renderer), TL_JOB_RUN);
    assert_memory_equal(dropped.texels, made.texels, (size_t)SIZE * SIZE * 4 * sizeof(float));
    tl_image_release(&dropped);
    tl_image_release(&made);
    ball->back.is_given = false;
    ball->coat = 1;
    test_scene_refresh(scene);
    made = test_scene_draw(scene, device->renderer);
    assert_int_equal(bounce_action(device->renderer), TL_JOB_RUN);
    tl_image_release(&made);
    test_scene_close(scene);
    free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_black_cloth),  cmocka_unit_test(test_sky),
        cmocka_unit_test(test_sheer),        cmocka_unit_test(test_shining_wall),
        cmocka_unit_test(test_lamp),         cmocka_unit_test(test_buried_lamp),
        cmocka_unit_test(test_lined_wall),   cmocka_unit_test(test_lamp_through_cloth),
        cmocka_unit_test(test_shaded_gloss), cmocka_unit_test(test_ground),
        cmocka_unit_test(test_split),        cmocka_unit_test(test_lag),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
