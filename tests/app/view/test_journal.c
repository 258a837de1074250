/* The journal of a window against the window's own history: what comes back after any end of the process. */
#include "app/view/memory/journal.h"
#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include "tests/testing.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define FOLDER  TOILE_SCRATCH_DIR "/state"
#define COMMAND 0x1234

static struct tl_settings some_settings(void)
{
    struct tl_settings settings;
    tl_error error;
    assert_true(tl_settings_load(&settings, &(struct tl_settings_source){0}, &error));
    return settings;
}

/* The only file in FOLDER/journal, or NULL. New string. */
static char *only_file(void)
{
    char *found = NULL;
    DIR *folder = opendir(FOLDER "/journal");
    for (struct dirent *entry; folder && (entry = readdir(folder));)
        if (entry->d_name[0] != '.') {
            assert_null(found);
            found = tl_format(FOLDER "/journal/%s", entry->d_name);
        }
    if (folder)
        closedir(folder);
    return found;
}

/* A review: four edits, a view, two undone, one redone. Returns its settings, and leaves its journal as a
 * process does that is killed: the lock is gone with the process. */
static struct tl_settings leave_review(void)
{
    struct tl_settings settings = some_settings();
    tl_history *history = tl_history_create(&settings);
    tl_journal *journal = tl_journal_begin(FOLDER, COMMAND, &settings);
    assert_non_null(journal);
    for (int i = 1; i <= 4; i++) {
        settings.material.glossiness = 0.1f * (float)i;
        settings.light.regions = 20 + i;
        assert_true(tl_history_note(history, &settings));
        tl_journal_note(journal, &settings, true);
    }
    settings.camera.yaw_deg = 77;
    tl_journal_note(journal, &settings, tl_history_note(history, &settings));
    tl_journal_note(journal, &settings, false); /* nothing has changed */
    for (int i = 0; i < 3; i++) {
        tl_history_restore(i < 2 ? tl_history_undo(history) : tl_history_redo(history), &settings);
        tl_journal_undo(journal, i == 2, &settings);
    }
    tl_history_destroy(&history);
    tl_journal_close(&journal, true);
    return settings;
}

static void a_killed_review_comes_back(void **state)
{
    (void)state;
    struct tl_settings left = leave_review();
    struct tl_recovered back;
    assert_null(tl_journal_recover(FOLDER, COMMAND + 1, &back)); /* of another command line */
    tl_journal *journal = tl_journal_recover(FOLDER, COMMAND, &back);
    assert_non_null(journal);
    assert_true(tl_settings_equal(&back.settings, &left));
    assert_int_equal(back.steps, 3);
    assert_near(back.settings.camera.yaw_deg, 77, 0);
    assert_near(tl_history_redo(back.history)->material.glossiness, 0.4, 1e-6);
    for (int i = 3; i >= 0; i--) {
        const struct tl_settings *edit = tl_history_undo(back.history);
        assert_non_null(edit);
        assert_int_equal(edit->light.regions, i > 0 ? 20 + i : some_settings().light.regions);
    }
    assert_null(tl_history_undo(back.history));
    tl_history_destroy(&back.history);

    /* It goes on, and a second kill loses nothing either. */
    tl_journal_resume(journal);
    back.settings.material.glossiness = 0.7f;
    tl_journal_note(journal, &back.settings, true);
    tl_journal_close(&journal, true);
    journal = tl_journal_recover(FOLDER, COMMAND, &back);
    assert_non_null(journal);
    assert_int_equal(back.steps, 4);
    assert_near(back.settings.material.glossiness, 0.7, 1e-6);
    tl_history_destroy(&back.history);
    tl_journal_close(&journal, false); /* closed by its user */
    assert_null(only_file());
    assert_null(tl_journal_recover(FOLDER, COMMAND, &back));
}

static void a_window_that_lives_keeps_its_journal(void **state)
{
    (void)state;
    struct tl_settings settings = some_settings();
    struct tl_recovered back;
    tl_journal *journal = tl_journal_begin(FOLDER, COMMAND, &settings);
    assert_null(tl_journal_recover(FOLDER, COMMAND, &back));
    tl_journal_close(&journal, false);
}

/* Cut off at any byte: what was whole comes back, and nothing else; before the end of the first record
 * nothing does. */
static void a_torn_end_is_cut_off(void **state)
{
    (void)state;
    leave_review();
    char *path = only_file(), *text;
    size_t size, last = SIZE_MAX;
    tl_error error;
    assert_true(tl_file_read(path, &text, &size, &error));
    size_t begun = (size_t)(strstr(text, "\n.\n") - text) + 3, recovered = 0;
    tl_log_set_level(TL_LOG_QUIET);
    for (size_t length = size; length > begun - 40; length--) {
        FILE *file = fopen(path, "w");
        fwrite(text, 1, length, file);
        fclose(file);
        struct tl_recovered back;
        tl_journal *journal = tl_journal_recover(FOLDER, COMMAND, &back);
        assert_int_equal(journal != NULL, length >= begun);
        if (!journal)
            continue;
        recovered++;
        assert_true(back.steps <= 4 && (last == SIZE_MAX || back.steps <= last + 1));
        last = back.steps;
        back.settings.material.glossiness =
            0.9f; /* what is added stands behind the cut, not in a torn record */
        tl_journal_note(journal, &back.settings, true);
        tl_history_destroy(&back.history);
        tl_journal_close(&journal, true);
        size_t steps = last;
        journal = tl_journal_recover(FOLDER, COMMAND, &back);
        assert_non_null(journal);
        assert_int_equal(back.steps, steps + 1);
        assert_near(back.settings.material.glossiness, 0.9, 1e-6);
        tl_history_destroy(&back.history);
        tl_journal_close(&journal, false);
    }
    tl_log_set_level(TL_LOG_INFO);
    assert_int_equal(recovered, size - begun + 1);
    assert_int_equal(last, 0);
    unlink(path);
    char *tried = tl_format("%s.tried", path);
    unlink(tried);
    free(tried);
    free(path);
    free(text);
}

static void what_ends_the_program_is_tried_three_times(void **state)
{
    (void)state;
    struct tl_recovered back;
    leave_review();
    for (int i = 0; i < 3; i++) {
        tl_journal *journal = tl_journal_recover(FOLDER, COMMAND, &back);
        assert_non_null(journal);
        tl_history_destroy(&back.history);
        tl_journal_close(&journal, true);
    }
    tl_log_set_level(TL_LOG_QUIET);
    assert_null(tl_journal_recover(FOLDER, COMMAND, &back));
    tl_log_set_level(TL_LOG_INFO);
    char *path = only_file();
    assert_non_null(strstr(path, ".tried"));
    unlink(path);
    free(path);
}

static void the_latest_of_two_comes_first(void **state)
{
    (void)state;
    struct tl_recovered back;
    leave_review();
    char *path = only_file(), *other = tl_format(FOLDER "/journal/%016x-1", COMMAND);
    const struct timespec old[2] = {{.tv_sec = 1000000000}, {.tv_sec = 1000000000}};
    assert_int_equal(rename(path, other), 0);
    leave_review();
    struct timespec hour_ago[2];
    clock_gettime(CLOCK_REALTIME, &hour_ago[0]);
    hour_ago[0].tv_sec -= 3600;
    hour_ago[1] = hour_ago[0];
    assert_int_equal(utimensat(AT_FDCWD, other, hour_ago, 0), 0);
    tl_journal *journal = tl_journal_recover(FOLDER, COMMAND, &back);
    assert_non_null(journal);
    tl_history_destroy(&back.history);
    tl_journal_close(&journal, false);
    assert_false(tl_file_exists(path));
    assert_true(tl_file_exists(other)); /* for the next window */
    assert_int_equal(utimensat(AT_FDCWD, other, old, 0), 0);
    assert_null(tl_journal_recover(FOLDER, COMMAND, &back)); /* nobody asked for it in a month */
    assert_false(tl_file_exists(other));
    free(other);
    free(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_killed_review_comes_back),
        cmocka_unit_test(a_window_that_lives_keeps_its_journal),
        cmocka_unit_test(a_torn_end_is_cut_off),
        cmocka_unit_test(what_ends_the_program_is_tried_three_times),
        cmocka_unit_test(the_latest_of_two_comes_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
