/* The C library, through its header alone: errors are values, scenes do not disturb each other, a scene may
 * be used on any thread, and the caller's locale does not change how numbers are read. */
#include "app/library/toile.h"

#include <locale.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define WIDTH  48
#define HEIGHT 40
#define FLOATS ((size_t)WIDTH * HEIGHT * 4)

static toile_scene *load(const char *yaw, toile_error *error)
{
    const char *const options[] = {"image.width=48",
                                   "image.height=40",
                                   "scene.preset=draft",
                                   "scene.garment=sheet",
                                   "scene.avatar=ball",
                                   "scene.fabric=none",
                                   "cloth.settle_s=0.2",
                                   "light.regions=24",
                                   "light.pem_size=16",
                                   "light.rounds=1",
                                   yaw,
                                   NULL};
    return toile_load(NULL, options, error);
}

static float *draw(toile_scene *scene)
{
    float *image = calloc(FLOATS, sizeof *image);
    toile_error error;
    if (!toile_draw(scene, image, FLOATS, &error))
        fail_msg("%s", error.message);
    return image;
}

static void errors_are_values(void **state)
{
    (void)state;
    toile_error error;
    assert_null(toile_load("no_such_scene.yaml", NULL, &error));
    assert_int_equal(error.code, TOILE_INPUT);
    assert_non_null(strstr(error.message, "no_such_scene.yaml"));
    assert_null(load("camera.yaw_dog=3", &error));
    assert_int_equal(error.code, TOILE_USAGE);
    assert_non_null(strstr(error.message, "camera.yaw_deg"));
    assert_null(load("camera.yaw_dog=3", NULL));

    toile_scene *scene = load("camera.yaw_deg=0", &error);
    assert_non_null(scene);
    assert_int_equal(error.code, TOILE_OK);
    int width, height;
    toile_size(scene, &width, &height);
    assert_int_equal(width, WIDTH);
    assert_int_equal(height, HEIGHT);
    float few[4];
    assert_false(toile_draw(scene, few, 4, &error));
    assert_int_equal(error.code, TOILE_USAGE);
    assert_false(toile_save(scene, "picture.bmp", &error));
    assert_int_equal(error.code, TOILE_USAGE);
    assert_false(toile_save(scene, "/no/such/folder/a.png", &error));
    assert_int_equal(error.code, TOILE_OUTPUT);
    toile_destroy(&scene);
    assert_null(scene);
    toile_destroy(&scene);
}

static void *draw_elsewhere(void *scene)
{
    return draw(scene);
}

/* Each scene alone is the oracle. */
static void scenes_do_not_disturb_each_other(void **state)
{
    (void)state;
    float *alone[2], *together;
    static const char *const yaws[] = {"camera.yaw_deg=0", "camera.yaw_deg=70"};
    for (int i = 0; i < 2; i++) {
        toile_scene *scene = load(yaws[i], NULL);
        alone[i] = draw(scene);
        toile_destroy(&scene);
    }
    assert_memory_not_equal(alone[0], alone[1], FLOATS * sizeof(float));

    toile_scene *scenes[] = {load(yaws[0], NULL), load(yaws[1], NULL)};
    for (int i = 0; i < 2; i++) {
        together = draw(scenes[i]);
        assert_memory_equal(together, alone[i], FLOATS * sizeof(float));
        free(together);
    }
    pthread_t thread;
    void *drawn;
    assert_int_equal(pthread_create(&thread, NULL, draw_elsewhere, scenes[0]), 0);
    assert_int_equal(pthread_join(thread, &drawn), 0);
    assert_memory_equal(drawn, alone[0], FLOATS * sizeof(float));
    free(drawn);
    toile_destroy(&scenes[0]);
    together = draw(scenes[1]); /* the other's context is gone */
    assert_memory_equal(together, alone[1], FLOATS * sizeof(float));
    free(together);
    toile_destroy(&scenes[1]);
    free(alone[0]);
    free(alone[1]);
}

static void a_step_moves_the_cloth(void **state)
{
    (void)state;
    toile_scene *scene = load("camera.yaw_deg=0", NULL);
    toile_error error;
    float *before = draw(scene), *after;
    assert_true(toile_settle(scene, &error)); /* it was draped: nothing happens */
    after = draw(scene);
    assert_memory_equal(before, after, FLOATS * sizeof(float));
    free(after);
    for (int i = 0; i < 5; i++)
        assert_true(toile_step(scene, &error));
    after = draw(scene);
    assert_memory_not_equal(before, after, FLOATS * sizeof(float));
    free(before);
    free(after);
    toile_destroy(&scene);
}

static void numbers_have_a_point_in_any_locale(void **state)
{
    (void)state;
    if (!setlocale(LC_ALL, "de_DE.UTF-8") && !setlocale(LC_ALL, "fr_FR.UTF-8"))
        skip(); /* no locale with a comma is installed */
    toile_error error = {0};
    toile_scene *scene = load("camera.yaw_deg=0.5", &error);
    assert_string_equal(error.message, "");
    assert_non_null(scene);
    toile_destroy(&scene);
    assert_string_equal(localeconv()->decimal_point, ",");
    setlocale(LC_ALL, "C");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_values),
        cmocka_unit_test(scenes_do_not_disturb_each_other),
        cmocka_unit_test(a_step_moves_the_cloth),
        cmocka_unit_test(numbers_have_a_point_in_any_locale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
