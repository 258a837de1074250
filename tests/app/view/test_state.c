/* The window's state: written and read back equal; broken files are reported and change nothing. */
#include "app/view/memory/recent.h"
#include "app/view/memory/saved_views.h"
#include "app/view/memory/state.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include "tests/testing.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static char folder[] = "/tmp/toile_state_XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    char *command = tl_format("rm -r %s", folder);
    int status = system(command); // NOLINT(cert-env33-c): a folder of the test's own
    free(command);
    return status;
}

static char *in_folder(const char *name)
{
    return tl_format("%s/%s", folder, name);
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static struct tl_settings some_settings(void)
{
    struct tl_settings settings;
    tl_error error;
    assert_true(tl_settings_load(&settings, &(struct tl_settings_source){0}, &error));
    return settings;
}

static void comes_back_as_it_was(void **unused)
{
    (void)unused;
    tl_error error;
    char *file = in_folder("deep/er/review.yaml");
    struct tl_settings defaults = some_settings();
    struct tl_state state, read;
    assert_true(tl_state_load(file, &defaults, &state, &error)); /* not there: defaults */
    assert_false(state.review.has_settings);
    assert_true(state.window.panel);
    state.window.width = 1000;
    state.window.panel = false;
    state.window.budget_ms = 33.5f;
    state.review.has_settings = true;
    assert_true(tl_settings_apply_fabric(&state.settings, "silk", &error));
    state.settings.material.glossiness = 0.1f + 0.2f;
    state.settings.camera.yaw_deg = -123.4567f;
    assert_true(tl_state_save(file, &state, &error));
    assert_true(tl_state_load(file, &defaults, &read, &error));
    assert_true(read.review.has_settings);
    assert_true(tl_settings_equal(&read.settings, &state.settings));
    assert_true(tl_options_equal(&tl_window_options, &read.window, &state.window));
    free(file);
}

/* The window alone, for reviews that began with a scene of their own: the settings stay out of the file. */
static void window_alone(void **unused)
{
    (void)unused;
    tl_error error;
    char *file = in_folder("window.yaml");
    struct tl_settings defaults = some_settings();
    struct tl_state state, read;
    assert_true(tl_state_load(file, &defaults, &state, &error));
    state.window.height = 555;
    assert_true(tl_state_save(file, &state, &error));
    assert_true(tl_state_load(file, &defaults, &read, &error));
    assert_false(read.review.has_settings);
    assert_int_equal(read.window.height, 555);
    free(file);
}

static void broken_file_means_defaults(void **unused)
{
    (void)unused;
    static const char *const texts[] = {
        "window: {width: 900, panel: maybe}\n",
        "window: [\n",
        "windw: {width: 900}\n",
        "\xff\xfe\n",
        "review: {has_settings: true}\nscene: {colourways: nosuch}\n",
    };
    tl_error error;
    struct tl_settings defaults = some_settings();
    for (size_t i = 0; i < TL_COUNT(texts); i++) {
        char *file = in_folder("broken.yaml");
        struct tl_state state;
        write_text(file, texts[i]);
        error.message[0] = '\0';
        assert_false(tl_state_load(file, &defaults, &state, &error));
        assert_true(strlen(error.message) > 0);
        assert_true(tl_options_equal(&tl_window_options, &state.window, tl_window_options.defaults));
        assert_false(state.review.has_settings);
        assert_true(tl_settings_equal(&state.settings, &defaults));
        struct tl_saved_views views;
        assert_false(tl_saved_views_load(file, &views, &error));
        for (int v = 0; v < TL_SAVED_VIEWS; v++)
            assert_false(views.of[v].saved);
        free(file);
    }
}

static void relative_files_become_absolute(void **unused)
{
    (void)unused;
    tl_error error;
    char *file = in_folder("paths.yaml"), *light = in_folder("light.exr");
    struct tl_settings defaults = some_settings();
    struct tl_state state = {.review = {.has_settings = true}, .settings = defaults};
    state.window = *(const struct tl_window_params *)tl_window_options.defaults;
    state.settings.scene.environment = "light.exr";
    char *before = realpath(".", NULL), *inside = realpath(folder, NULL);
    assert_int_equal(chdir(folder), 0);
    assert_true(tl_state_save(file, &state, &error));
    assert_int_equal(chdir(before), 0);
    struct tl_state read;
    assert_true(tl_state_load(file, &defaults, &read, &error));
    char *expected = tl_format("%s/light.exr", inside);
    assert_string_equal(read.settings.scene.environment, expected);
    assert_string_equal(read.settings.scene.garment, "dress"); /* a name, no file */
    free(expected);
    free(before);
    free(inside);
    free(light);
    free(file);
}

static void views_come_back(void **unused)
{
    (void)unused;
    tl_error error;
    char *file = in_folder("views/some.yaml");
    struct tl_saved_views views, read;
    assert_true(tl_saved_views_load(file, &views, &error));
    struct tl_settings settings = some_settings(), seen = settings;
    settings.camera = (struct tl_camera_params){
        .yaw_deg = 12, .pitch_deg = -3, .distance_m = 1.5f, .target = {1, 2, 3}, .fov_deg = 40};
    settings.scene.environment_yaw_deg = 77;
    settings.lamp.irradiance[1] = 0.75f;
    views.of[2] = tl_saved_view_take(&settings);
    views.of[8] = tl_saved_view_take(&settings);
    assert_true(tl_saved_views_save(file, &views, &error));
    assert_true(tl_saved_views_load(file, &read, &error));
    for (int i = 0; i < TL_SAVED_VIEWS; i++)
        assert_int_equal(read.of[i].saved, i == 2 || i == 8);
    tl_saved_view_apply(&read.of[2], &seen);
    assert_true(tl_settings_equal(&seen, &settings));
    free(file);
}

static void names_tell_scenes_apart(void **unused)
{
    (void)unused;
    struct tl_settings settings = some_settings();
    char *dress = tl_saved_views_name(&settings.scene);
    settings.scene.environment_yaw_deg = 5;
    char *same = tl_saved_views_name(&settings.scene);
    settings.scene.garment = "/some/where/dress.glb";
    char *other = tl_saved_views_name(&settings.scene);
    assert_string_equal(dress, same);
    assert_string_not_equal(dress, other);
    assert_null(strchr(other, '/'));
    free(dress);
    free(same);
    free(other);
}

static void folder_follows_the_standard(void **unused)
{
    (void)unused;
    const struct {
        const char *state, *home, *expected;
    } cases[] = {{"/s", "/h", "/s/toile"},
                 {"relative", "/h", "/h/.local/state/toile"},
                 {NULL, "/h", "/h/.local/state/toile"},
                 {NULL, NULL, NULL}};
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        cases[i].state ? setenv("XDG_STATE_HOME", cases[i].state, 1) : unsetenv("XDG_STATE_HOME");
        cases[i].home ? setenv("HOME", cases[i].home, 1) : unsetenv("HOME");
        char *found = tl_state_folder();
        if (cases[i].expected)
            assert_string_equal(found, cases[i].expected);
        else
            assert_null(found);
        free(found);
    }
}

/* Twelve files leave ten, the latest first; one that is opened again moves to the front and is there once.
 * What is written is read back equal, names with a colon and quotes included, and no temporary file stays. */
static void recent_files_are_the_last_ten(void **state)
{
    (void)state;
    struct tl_recent *recent = TL_NEW(struct tl_recent), *read = TL_NEW(struct tl_recent);
    tl_error error = {0};
    assert_int_equal(tl_recent_count(recent), 0);
    for (int i = 0; i < 12; i++) {
        char *path = tl_format("/garments/\"no: %d\"/it's é.obj", i);
        tl_recent_add(recent, path);
        free(path);
    }
    assert_int_equal(tl_recent_count(recent), TL_RECENT_MAX);
    assert_string_equal(recent->garments[0], "/garments/\"no: 11\"/it's é.obj");
    assert_string_equal(recent->garments[9], "/garments/\"no: 2\"/it's é.obj");
    tl_recent_add(recent, "/garments/\"no: 5\"/it's é.obj");
    assert_string_equal(recent->garments[0], "/garments/\"no: 5\"/it's é.obj");
    assert_string_equal(recent->garments[1], "/garments/\"no: 11\"/it's é.obj");
    assert_string_equal(recent->garments[9], "/garments/\"no: 2\"/it's é.obj");
    for (int i = 1; i < TL_RECENT_MAX; i++)
        assert_string_not_equal(recent->garments[i], recent->garments[0]);
    char *file = in_folder("new folder/recent.yaml"), *made = in_folder("new folder");
    assert_ok(tl_recent_save(file, recent, &error), error);
    assert_ok(tl_recent_load(file, read, &error), error);
    assert_memory_equal(read->garments, recent->garments, sizeof read->garments);
    char *command = tl_format("test \"$(ls '%s')\" = recent.yaml", made);
    assert_int_equal(system(command), 0); // NOLINT(cert-env33-c): a folder of the test's own
    write_text(file, "recent: {garment_11: x}\n");
    assert_false(tl_recent_load(file, read, &error));
    assert_int_equal(tl_recent_count(read), 0);
    free(command);
    free(made);
    free(file);
    free(read);
    free(recent);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(comes_back_as_it_was),
        cmocka_unit_test(window_alone),
        cmocka_unit_test(broken_file_means_defaults),
        cmocka_unit_test(relative_files_become_absolute),
        cmocka_unit_test(views_come_back),
        cmocka_unit_test(names_tell_scenes_apart),
        cmocka_unit_test(recent_files_are_the_last_ten),
        cmocka_unit_test(folder_follows_the_standard),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
