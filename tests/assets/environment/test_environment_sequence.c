/* Sequences of environments: patterns, numbers, gaps, damaged frames. */
#include "assets/environment/environment_sequence.h"
#include "assets/image/exr.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include "tests/testing.h"

#include <string.h>

#define FOLDER TOILE_SCRATCH_DIR "/sequence"

/* 4 x 2 texels of radiance `value`. */
static void write_frame(const char *name, float value)
{
    static const char *const channels[] = {"R", "G", "B"};
    tl_image image = tl_image_create(4, 2, 3, TL_IMAGE_F32);
    for (int i = 0; i < 24; i++)
        tl_image_floats(&image)[i] = value;
    tl_error error = {0};
    char *path = tl_format(FOLDER "/%s", name);
    assert_ok(tl_folder_make(FOLDER, &error), error);
    const struct tl_exr_layer layer = {channels, &image};
    assert_ok(tl_exr_save(path, &layer, 1, &error), error);
    free(path);
    tl_image_release(&image);
}

static void write_text(const char *name)
{
    char *path = tl_format(FOLDER "/%s", name);
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    fputs("no picture\n", stream);
    fclose(stream);
    free(path);
}

static void patterns_are_recognised(void **state)
{
    (void)state;
    assert_true(tl_environment_is_sequence("sky.####.exr"));
    assert_true(tl_environment_is_sequence("/a/b/#.hdr"));
    assert_false(tl_environment_is_sequence("studio"));
    assert_false(tl_environment_is_sequence("a#b/sky.exr"));
    write_frame("odd#name.exr", 1); /* a file is a file */
    assert_false(tl_environment_is_sequence(FOLDER "/odd#name.exr"));
}

/* Numbers from 8 to 11, one more digit than there are #; other files in the folder are not frames. */
static void frames_are_found_in_order(void **state)
{
    (void)state;
    const char *const frames[] = {"day.10.exr", "day.8.exr", "day.11.exr", "day.9.exr"};
    const float values[] = {10, 8, 11, 9};
    for (size_t i = 0; i < TL_COUNT(frames); i++)
        write_frame(frames[i], values[i]);
    const char *const others[] = {"day.exr",       "day.07.exr",   "day.x.exr",
                                  "day.8.exr.bak", "night.12.exr", "day.-7.exr"};
    for (size_t i = 0; i < TL_COUNT(others); i++)
        write_text(others[i]);

    tl_environment_sequence sequence;
    tl_error error = {0};
    assert_ok(tl_environment_sequence_open(FOLDER "/day.#.exr", &sequence, &error), error);
    assert_int_equal(sequence.first, 8);
    assert_int_equal(sequence.count, 4);
    for (int i = 0; i < 4; i++) {
        tl_environment environment;
        assert_ok(tl_environment_sequence_load(&sequence, i, &environment, &error), error);
        assert_near(tl_image_floats(&environment.image)[0], 8 + i, 0);
        char *name = tl_format("day.%d.exr", 8 + i);
        assert_string_equal(environment.name, name);
        free(name);
        tl_environment_release(&environment);
    }
    tl_environment_sequence_release(&sequence);
}

static void numbers_are_padded_with_zeros(void **state)
{
    (void)state;
    write_frame("dawn_0000.exr", 1);
    write_frame("dawn_0001.exr", 2);
    write_frame("dawn_1.exr", 3); /* too few digits */
    tl_environment_sequence sequence;
    tl_error error = {0};
    assert_ok(tl_environment_sequence_open(FOLDER "/dawn_####.exr", &sequence, &error), error);
    assert_int_equal(sequence.first, 0);
    assert_int_equal(sequence.count, 2);
    tl_environment_sequence_release(&sequence);
}

static void expect_refusal(const char *pattern, const char *part)
{
    tl_environment_sequence sequence;
    tl_error error = {0};
    assert_false(tl_environment_sequence_open(pattern, &sequence, &error));
    if (!strstr(error.message, part))
        print_error("%s\n", error.message);
    assert_non_null(strstr(error.message, part));
}

static void errors_name_the_cause(void **state)
{
    (void)state;
    write_frame("gap.01.exr", 1);
    write_frame("gap.02.exr", 1);
    write_frame("gap.05.exr", 1);
    expect_refusal(FOLDER "/gap.##.exr", "gap.03.exr: is missing between frames 1 and 5");
    expect_refusal(FOLDER "/none.##.exr", "none.##.exr: no file has such a name");
    expect_refusal(FOLDER "/nowhere/a.##.exr", "its folder cannot be read");
    expect_refusal(FOLDER "/a.#.b.#.exr", "one run of up to 9 #");
    expect_refusal(FOLDER "/a.exr", "one run of up to 9 #");
    expect_refusal(FOLDER "/a.##########.exr", "one run of up to 9 #");

    write_frame("torn.1.exr", 1);
    write_text("torn.2.exr");
    tl_environment_sequence sequence;
    tl_environment environment;
    tl_error error = {0};
    assert_ok(tl_environment_sequence_open(FOLDER "/torn.#.exr", &sequence, &error), error);
    assert_ok(tl_environment_sequence_load(&sequence, 0, &environment, &error), error);
    tl_environment_release(&environment);
    assert_false(tl_environment_sequence_load(&sequence, 1, &environment, &error));
    assert_non_null(strstr(error.message, "torn.2.exr"));
    tl_environment_sequence_release(&sequence);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patterns_are_recognised),
        cmocka_unit_test(frames_are_found_in_order),
        cmocka_unit_test(numbers_are_padded_with_zeros),
        cmocka_unit_test(errors_name_the_cause),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
