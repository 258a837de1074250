/* What a technique that is compared takes from the scene, whatever its preset says. */
#include "tests/testing.h"

#include "app/measure/measure.h"
#include "config/base/memory.h"

static struct tl_settings applied(const char *option)
{
    const char *const assignments[] = {"image.width=123", option};
    const struct tl_settings_source source = {
        .scene_file = "review", .assignments = assignments, .assignment_count = TL_COUNT(assignments)};
    const struct tl_setup setup = {.preset = "review", .assignments = {"light.regions=48"}};
    struct tl_settings scene, out;
    tl_error error = {0};
    assert_ok(tl_settings_load(&scene, &source, &error), error);
    assert_ok(tl_setup_apply(&setup, &scene, &out, &error), error);
    return out;
}

static void presets_leave_the_scene(void **state)
{
    (void)state;
    const struct tl_settings off = applied("light.bounce=off"), one = applied("light.bounce=one"),
                             all = applied("light.bounce=all"), black = applied("light.reflect_scene=false");
    assert_int_equal(off.light.bounce, TL_BOUNCE_OFF); /* review has all of it on */
    assert_int_equal(one.light.bounce, TL_BOUNCE_ONE);
    assert_int_equal(all.light.bounce, TL_BOUNCE_ALL);
    assert_true(all.light.reflect_scene);
    assert_false(black.light.reflect_scene);
    assert_int_equal(off.image.width, 123);
    assert_int_equal(off.light.regions, 48);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(presets_leave_the_scene)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
