/* Bounced light as drawn against the reference's: a ball under a waved sheet on the ground, and a white fold
 * before a red wall; lit at samples and at vertices, matt and glossy. */
#include "tests/render/scenes.h"

#include "config/memory.h"
#include "render/reference/reference.h"

#include "tests/testing.h"

#define SIZE 40

static tl_image reference_of(struct test_scene *scene)
{
    tl_error error = {0};
    struct tl_reference_report report;
    tl_image image;
    test_scene_refresh(scene);
    scene->settings.reference.strata = 512;
    scene->settings.reference.replicates = 8;
    scene->settings.reference.bounce_samples = 32;
    const struct tl_reference_request request =
        tl_frame_reference_request(&scene->frame, &scene->settings, NULL);
    assert_ok(tl_reference_draw(&request, &image, &report, &error), error);
    printf("reference: standard error %.2f %%\n", 100 * report.standard_error);
    assert_true(report.standard_error < 0.03);
    return image;
}

static void use_rays(struct test_scene *scene, int ratio_at)
{
    struct tl_light_params *light = &scene->settings.light;
    light->lobe = TL_LOBE_DUAL;
    light->cut = TL_CUT_SPHERE;
    light->regions = 192;
    light->sun = true;
    light->visibility = TL_VISIBILITY_RAYS;
    light->composition = TL_COMPOSE_RATIO;
    light->jitter = true;
    light->rounds = 32;
    light->ratio_at = ratio_at;
    scene->settings.image.supersample = 1;
}

static double mean_of(const tl_image *image, int channel)
{
    double sum = 0;
    for (int i = 0; i < image->width * image->height; i++)
        sum += (double)tl_image_floats(image)[4 * i + channel];
    return sum / (image->width * image->height);
}

/* A white sheet, waved, before a red wall that stands upright behind it. */
static struct test_scene *fold_scene(float glossiness)
{
    struct test_scene *scene = TL_NEW(struct test_scene);
    test_scene_open(scene, test_environment(64, 32, test_daylight), (vec3s){{0.7f, 1.1f, 1.3f}},
                    (vec3s){{0, 0.1f, 0}}, 40, SIZE, SIZE);
    tl_material *sheet = test_scene_add(scene, test_sheet(0.1f, 0.5f, 0.12f, 2, 48));
    sheet->diffuse = (vec3s){{0.6f, 0.6f, 0.6f}};
    sheet->specular = glossiness > 0 ? (vec3s){{0.3f, 0.3f, 0.3f}} : (vec3s){{0, 0, 0}};
    sheet->glossiness = glossiness;
    scene->frame.still = true;
    tl_material *wall = test_scene_add(
        scene, test_square((vec3s){{0, 0.4f, -0.5f}}, (vec3s){{1, 0, 0}}, (vec3s){{0, 0, 1}}, 0.5f, 24));
    wall->diffuse = (vec3s){{0.8f, 0.05f, 0.05f}};
    wall->specular = (vec3s){{0, 0, 0}};
    return scene;
}

static void scene_free(struct test_scene *scene)
{
    test_scene_close(scene);
    free(scene);
}

/* Of the mean that is missing without bounces, 85 % is there with them in a matt sheet. In a glossy one,
 * whose lobes look along the sheet at the wall, half: two bands do not hold a narrow light near the horizon.
 */
static void test_against_reference(void **state)
{
    struct test_device *device = *state;
    const float glossinesses[] = {0, 0.8f};
    for (size_t g = 0; g < TL_COUNT(glossinesses); g++)
        for (int bounce = TL_BOUNCE_ONE; bounce <= TL_BOUNCE_ALL; bounce++) {
            struct test_scene *scene = fold_scene(glossinesses[g]);
            scene->settings.light.bounce = bounce;
            tl_image exact = reference_of(scene);
            for (int ratio_at = TL_RATIO_AT_SAMPLES; ratio_at <= TL_RATIO_AT_VERTICES; ratio_at++) {
                use_rays(scene, ratio_at);
                scene->settings.light.bounce = TL_BOUNCE_OFF;
                tl_image off = test_scene_draw(scene, device->renderer);
                scene->settings.light.bounce = bounce;
                tl_image on = test_scene_draw(scene, device->renderer);
                double without = test_compare(&off, &exact).rel_rmse;
                double with = test_compare(&on, &exact).rel_rmse;
                printf("glossiness %.1f, bounce %d, ratio %d: relative RMSE %.2f %% without, %.2f %% with; "
                       "means",
                       (double)glossinesses[g], bounce, ratio_at, 100 * without, 100 * with);
                for (int c = 0; c < 3; c++) {
                    double truth = mean_of(&exact, c), lacking = truth - mean_of(&off, c);
                    double wrong = mean_of(&on, c) - truth;
                    printf(" %+.2f (%+.2f)", 100 * wrong / truth, -100 * lacking / truth);
                    assert_true(fabs(wrong) < (glossinesses[g] > 0 ? 0.35 : 0.2) * lacking);
                }
                printf(" %%\n");
                assert_true(with < (glossinesses[g] > 0 ? 0.5 : 0.3) * without);
                tl_image_release(&off);
                tl_image_release(&on);
            }
            tl_image_release(&exact);
            scene_free(scene);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_reference),
    };
    return cmocka_run_group_tests(tests, test_device_open, test_device_close);
}
