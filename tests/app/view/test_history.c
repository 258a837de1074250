/* Undo and redo against a plain list of states. */
#include "app/view/memory/history.h"

#include "tests/testing.h"

#include <stdlib.h>
#include <string.h>

static struct tl_settings some_settings(void)
{
    struct tl_settings settings;
    tl_error error;
    assert_true(tl_settings_load(&settings, &(struct tl_settings_source){0}, &error));
    return settings;
}

static struct tl_settings with_gloss(struct tl_settings settings, float glossiness)
{
    settings.material.glossiness = glossiness;
    return settings;
}

static void goes_back_and_forth(void **state)
{
    (void)state;
    struct tl_settings start = some_settings();
    tl_history *history = tl_history_create(&start);
    assert_null(tl_history_undo(history));
    for (int i = 1; i <= 3; i++) {
        struct tl_settings edited = with_gloss(start, 0.1f * (float)i);
        assert_true(tl_history_note(history, &edited));
        assert_false(tl_history_note(history, &edited));
    }
    assert_null(tl_history_redo(history));
    assert_near(tl_history_undo(history)->material.glossiness, 0.2, 1e-6);
    assert_near(tl_history_undo(history)->material.glossiness, 0.1, 1e-6);
    assert_near(tl_history_redo(history)->material.glossiness, 0.2, 1e-6);
    /* An edit made here cuts off what could have been redone. */
    struct tl_settings other = with_gloss(start, 0.9f);
    assert_true(tl_history_note(history, &other));
    assert_null(tl_history_redo(history));
    assert_near(tl_history_undo(history)->material.glossiness, 0.2, 1e-6);
    assert_near(tl_history_undo(history)->material.glossiness, 0.1, 1e-6);
    assert_true(tl_settings_equal(tl_history_undo(history), &start));
    assert_null(tl_history_undo(history));
    tl_history_destroy(&history);
    assert_null(history);
}

/* Many more edits than it keeps: the last ones are all there, in order, and nothing before them. */
static void forgets_the_oldest(void **state)
{
    (void)state;
    const int edits = 3 * TL_HISTORY_EDITS + 5;
    struct tl_settings start = some_settings();
    tl_history *history = tl_history_create(&start);
    for (int i = 1; i <= edits; i++) {
        struct tl_settings edited = with_gloss(start, (float)i / (float)(2 * edits));
        assert_true(tl_history_note(history, &edited));
    }
    for (int i = edits - 1; i >= edits - TL_HISTORY_EDITS; i--) {
        const struct tl_settings *edit = tl_history_undo(history);
        assert_non_null(edit);
        assert_near(edit->material.glossiness, (double)i / (2 * edits), 1e-6);
    }
    assert_null(tl_history_undo(history));
    tl_history_destroy(&history);
}

static void camera_and_size_are_no_edits(void **state)
{
    (void)state;
    struct tl_settings start = some_settings(), moved = start;
    tl_history *history = tl_history_create(&start);
    moved.camera.yaw_deg += 40;
    moved.image.width += 100;
    assert_false(tl_history_note(history, &moved));
    struct tl_settings edited = with_gloss(moved, 0.123f);
    assert_true(tl_history_note(history, &edited));
    tl_history_restore(tl_history_undo(history), &edited);
    assert_true(tl_settings_equal(&edited, &moved));
    tl_history_destroy(&history);
}

static void says_what_differs(void **state)
{
    (void)state;
    struct tl_settings start = with_gloss(some_settings(), 0.25f), edited = with_gloss(start, 0.5f);
    char *text = tl_history_describe(&start, &edited);
    assert_string_equal(text, "material.glossiness 0.25 -> 0.5");
    free(text);
    edited.light.rounds += 1;
    edited.scene.environment_yaw_deg = 90;
    text = tl_history_describe(&start, &edited);
    assert_string_equal(text, "scene.environment_yaw_deg 0 -> 90 and 2 more");
    free(text);
    text = tl_history_describe(&start, &start);
    assert_string_equal(text, "nothing");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(goes_back_and_forth),
        cmocka_unit_test(forgets_the_oldest),
        cmocka_unit_test(camera_and_size_are_no_edits),
        cmocka_unit_test(says_what_differs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
