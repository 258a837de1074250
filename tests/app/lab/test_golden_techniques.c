/* Techniques of the experiments' table that have a golden name, drawn as the gallery draws them and compared
 * with the images in tests/app/lab/golden/: reflectance models, environment maps, fabric detail, shading
 * under a lamp, weaves, knits, coats, fuzz and open cloth. */
#include "tests/golden.h"

#include "app/lab/experiments/experiments.h"
#include "app/lab/experiments/picture.h"
#include "app/scene/session.h"
#include "config/cache/cache.h"

#include <string.h>

#define SIDE 64
#define CACHE                                                                                                \
    TOILE_SCRATCH_DIR "/golden_cache" /* of this run: many pictures show one drape, under one sky            \
                                       */

static int open_device(void **state)
{
    tl_error error = {0};
    tl_gpu *gpu = tl_gpu_create_headless(&error);
    tl_cache_clear(CACHE);
    tl_cache_use(CACHE, TL_CACHE_LIMIT_BYTES);
    *state = gpu;
    return gpu ? 0 : -1;
}

static int close_device(void **state)
{
    tl_gpu *gpu = *state;
    tl_gpu_destroy(&gpu);
    tl_cache_use(NULL, 0);
    tl_cache_clear(CACHE);
    return 0;
}

static void draw(tl_gpu *gpu, const struct tl_experiment_picture *picture, tl_image *out)
{
    struct tl_settings settings;
    tl_error error = {0};
    assert_ok(tl_picture_settings(picture, TL_PICTURE_SOLID, SIDE, false, &settings, &error), error);
    settings.construction.show = TL_CONSTRUCTION_NEVER; /* a sheet's hems are another subject */
    tl_session *session = tl_session_create(&settings, &error);
    assert_ok(session != NULL, error);
    tl_renderer *renderer = tl_renderer_create(gpu, &error);
    assert_ok(renderer != NULL, error);
    const struct tl_render_settings render = tl_settings_render(&settings);
    tl_frame frame = tl_session_frame(session);
    frame.still = true;
    assert_ok(tl_renderer_draw(renderer, &frame, &render, &error), error);
    assert_ok(tl_renderer_read(renderer, out, &error), error);
    tl_renderer_destroy(&renderer);
    tl_session_destroy(&session);
}

/* Checks the goldens of one experiment whose names begin with the family's, under the first appearance.
 * Returns their number. */
static int check_experiment(tl_gpu *gpu, const struct tl_experiment *experiment, const char *family)
{
    struct tl_experiment_picture picture = {.experiment = experiment, .appearance = experiment->appearances};
    int count = 0;
    while ((picture.technique = tl_experiment_next(experiment, TL_OUTPUT_GOLDEN, picture.technique))) {
        tl_image image = {0};
        if (strncmp(picture.technique->golden, family, strlen(family)) != 0)
            continue;
        draw(gpu, &picture, &image);
        golden_check("tests/app/lab/golden", picture.technique->golden, &image);
        tl_image_release(&image);
        count++;
    }
    return count;
}

static void check_family(tl_gpu *gpu, const char *family)
{
    static const enum tl_output outputs[] = {TL_OUTPUT_PICTURES, TL_OUTPUT_GOLDEN};
    const struct tl_experiment *experiment;
    int count = 0;
    for (size_t o = 0; o < TL_COUNT(outputs); o++)
        for (size_t i = 0; (experiment = tl_experiment_at(outputs[o], i)); i++)
            count += check_experiment(gpu, experiment, family);
    assert_true(count > 0);
}

static void test_brdf(void **state)
{
    check_family(*state, "brdf");
}

static void test_local(void **state)
{
    check_family(*state, "local");
}

static void test_envmap(void **state)
{
    check_family(*state, "envmap");
}

static void test_detail(void **state)
{
    check_family(*state, "detail");
}

static void test_weave(void **state)
{
    check_family(*state, "weave");
}

static void test_coat(void **state)
{
    check_family(*state, "coat");
}

static void test_fuzz(void **state)
{
    check_family(*state, "fuzz");
}

static void test_open_cloth(void **state)
{
    check_family(*state, "open_cloth");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_brdf),       cmocka_unit_test(test_local), cmocka_unit_test(test_envmap),
        cmocka_unit_test(test_detail),     cmocka_unit_test(test_weave), cmocka_unit_test(test_coat),
        cmocka_unit_test(test_open_cloth), cmocka_unit_test(test_fuzz),
    };
    return cmocka_run_group_tests(tests, open_device, close_device);
}
