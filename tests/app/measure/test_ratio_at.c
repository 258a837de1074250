/* Pictures of garments that people look at, with ratios at vertices against ratios at every sample: the
 * garment's FLIP, as shown. tests/render/shade/test_pixels.c takes the parts one by one. */
#include "tests/testing.h"

#include "app/measure/measure.h"
#include "app/scene/session.h"
#include "config/base/memory.h"

#include <string.h>

struct garment_case {
    const char *name, *option;
    const char *file;   /* real data, or NULL: the built-in dress */
    double mean, worst; /* measured, and at most a third of it: they detect a fault */
};

static const struct garment_case cases[] = {
    {"satin", "scene.fabric=satin", NULL, 0.026, 0.125},
    {"denim", "scene.fabric=denim", NULL, 0.0088, 0.048},
    {"casual suit", "scene.garment=", "garments/mh_male_casualsuit06.glb", 0.027, 0.087},
};

static void draw(tl_renderer *renderer, const tl_frame *frame, struct tl_render_settings *settings, int at,
                 tl_image *shown)
{
    tl_error error = {0};
    settings->light.ratio_at = at;
    assert_ok(tl_renderer_forget_scene(renderer, &error), error);
    assert_ok(tl_renderer_draw(renderer, frame, settings, &error), error);
    assert_ok(tl_renderer_show_image(renderer, shown, &error), error);
}

/* A frame in motion, against the still one: with light at the cloth's own vertices it may differ by a fifth
 * more than with light at all that are drawn. */
static void check_motion(tl_renderer *renderer, tl_frame frame, struct tl_render_settings *settings,
                         const tl_image *still, const tl_image *mask)
{
    tl_surface surfaces[3];
    double mean[2];
    bool follows = false;
    assert_true(frame.surface_count <= TL_COUNT(surfaces));
    for (size_t i = 0; i < frame.surface_count; i++)
        follows |= frame.surfaces[i].light_mesh != NULL;
    assert_true(follows);
    memcpy(surfaces, frame.surfaces, frame.surface_count * sizeof *surfaces);
    frame.surfaces = surfaces;
    frame.still = false;
    for (int own = 1; own >= 0; own--) {
        tl_image moving;
        tl_error error = {0};
        struct tl_object_error result;
        for (size_t i = 0; i < frame.surface_count && !own; i++) {
            surfaces[i].light_mesh = NULL;
            surfaces[i].topology_revision += 1000;
        }
        draw(renderer, &frame, settings, TL_RATIO_AT_VERTICES, &moving);
        assert_ok(tl_image_compare_object(&moving, still, mask, 0, &result, &error), error);
        mean[own] = result.flip_mean;
        tl_image_release(&moving);
    }
    printf("%-12s in motion: FLIP mean %.4f, light at all vertices %.4f\n", "", mean[1], mean[0]);
    assert_near(mean[1], 0, 1.3 * mean[0]);
}

static void check_garment(tl_renderer *renderer, const struct garment_case *item)
{
    char option[1100];
    snprintf(option, sizeof option, "%s%s", item->option, item->file ? test_data(item->file) : "");
    const char *const assignments[] = {option,
                                       "cloth.edge_m=0.02",
                                       "cloth.settle_s=0.5",
                                       "image.width=450",
                                       "image.height=400",
                                       "image.supersample=1",
                                       "light.rounds=2",
                                       "light.pem_size=32",
                                       "light.repair_rest=0"};
    const struct tl_settings_source source = {NULL, assignments, TL_COUNT(assignments)};
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_settings_load(&settings, &source, &error), error);
    tl_session *session = tl_session_create(&settings, &error);
    assert_ok(session != NULL, error);
    struct tl_render_settings render = tl_settings_render(&settings);
    tl_frame frame = tl_session_frame(session);
    tl_image sampled, interpolated, mask;
    struct tl_object_error result;
    frame.still = frame.aovs = true;
    draw(renderer, &frame, &render, TL_RATIO_AT_SAMPLES, &sampled);
    assert_ok(tl_renderer_read_garment(renderer, &mask, &error), error);
    frame.aovs = false;
    draw(renderer, &frame, &render, TL_RATIO_AT_VERTICES, &interpolated);
    assert_ok(tl_image_compare_object(&interpolated, &sampled, &mask, 0, &result, &error), error);
    if (item == cases)
        check_motion(renderer, frame, &render, &interpolated, &mask);
    printf("%-12s %6zu pixels, FLIP mean %.4f, worst %.4f\n", item->name, result.pixels, result.flip_mean,
           result.flip_worst);
    assert_true(result.pixels > 5000 && result.flip_mean > 0);
    assert_near(result.flip_mean, 0, item->mean);
    assert_near(result.flip_worst, 0, item->worst);
    tl_image_release(&sampled);
    tl_image_release(&interpolated);
    tl_image_release(&mask);
    tl_session_destroy(&session);
}

static void check_at(size_t index)
{
    tl_error error = {0};
    tl_gpu *gpu = tl_gpu_create_headless(&error);
    assert_ok(gpu != NULL, error);
    tl_renderer *renderer = tl_renderer_create(gpu, &error);
    assert_ok(renderer != NULL, error);
    check_garment(renderer, &cases[index]);
    tl_renderer_destroy(&renderer);
    tl_gpu_destroy(&gpu);
}

static void test_fabrics(void **state)
{
    (void)state;
    for (size_t i = 0; i < 2; i++)
        check_at(i);
}

static void test_suit(void **state)
{
    (void)state;
    test_data(cases[2].file);
    check_at(2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_fabrics), cmocka_unit_test(test_suit)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
