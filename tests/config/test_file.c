/* Files are read whole or refused in one line, and written whole or not at all, without leftovers. */
#include "tests/testing.h"

#include "config/base/file.h"
#include "config/base/interrupt.h"
#include "config/base/memory.h"
#include "config/embedded.h"

#include <dirent.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>

#define FOLDER TOILE_SCRATCH_DIR "/file"

static size_t count_entries(const char *folder)
{
    size_t count = 0;
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (struct dirent *entry; (entry = readdir(directory)) != NULL;)
        count += entry->d_name[0] != '.';
    closedir(directory);
    return count;
}

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *where)
{
    (void)status;
    (void)type;
    (void)where;
    return remove(path);
}

static int begin(void **state)
{
    (void)state;
    tl_error error = {0};
    nftw(FOLDER, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
    assert_ok(tl_folder_make(FOLDER, &error), error);
    return 0;
}

static void write_text(const char *path, const char *text)
{
    tl_error error = {0};
    struct tl_writer writer;
    assert_ok(tl_writer_begin(&writer, path, &error), error);
    fputs(text, writer.stream);
    assert_ok(tl_writer_commit(&writer, &error), error);
}

static void assert_holds(const char *path, const char *text)
{
    char *data = NULL;
    size_t size = 0;
    tl_error error = {0};
    assert_ok(tl_file_read(path, &data, &size, &error), error);
    assert_int_equal(size, strlen(text));
    assert_string_equal(data, text); /* a NUL follows */
    free(data);
}

static void test_write_and_read(void **state)
{
    (void)state;
    write_text(FOLDER "/a", "one");
    assert_holds(FOLDER "/a", "one");
    write_text(FOLDER "/a", "another");
    assert_holds(FOLDER "/a", "another");
    assert_int_equal(count_entries(FOLDER), 1); /* no temporary file is left */
    struct stat status;
    assert_int_equal(stat(FOLDER "/a", &status), 0);
    mode_t mask = umask(0);
    umask(mask);
    assert_int_equal(status.st_mode & 0777, 0666 & ~mask); /* an ordinary file, not mkstemp's private one */
}

static void refuse_read(const char *path, const char *message)
{
    char *data = NULL;
    size_t size = 0;
    tl_error error = {0};
    assert_false(tl_file_read(path, &data, &size, &error));
    assert_string_equal(error.message, message);
    assert_int_equal(error.code, TL_INPUT);
    assert_null(data);
    assert_false(tl_file_check(path, &error));
    assert_string_equal(error.message, message);
}

static void test_reading_is_refused(void **state)
{
    (void)state;
    write_text(FOLDER "/empty", "");
    write_text(FOLDER "/a", "text");
    assert_int_equal(mkfifo(FOLDER "/pipe", 0600), 0);
    refuse_read("", "no file name given: name a file");
    refuse_read(FOLDER "/none", FOLDER "/none: no such file: check the path");
    refuse_read(FOLDER "/a/b", FOLDER "/a/b: no such file: check the path");
    refuse_read(FOLDER, FOLDER ": is a folder: name a file in it");
    refuse_read(FOLDER "/empty", FOLDER "/empty: is empty: write or fetch it again");
    refuse_read(FOLDER "/pipe", FOLDER "/pipe: is not a regular file: copy its contents to one");
    tl_error error = {0};
    char *data = NULL;
    size_t size = 0;
    assert_false(tl_file_read_small(FOLDER "/a", 3, &data, &size, &error));
    assert_ok(tl_file_read_small(FOLDER "/a", 4, &data, &size, &error), error);
    free(data);
    /* A file that claims 5 GiB, with holes, is refused by its length before memory is asked for. */
    assert_int_equal(truncate(FOLDER "/a", (off_t)5 << 30), 0);
    refuse_read(FOLDER "/a", FOLDER "/a: is larger than 4096 MiB: make it smaller");
}

static void set_age(const char *path, long seconds)
{
    struct timespec times[2] = {{.tv_sec = time(NULL) - seconds}, {.tv_sec = time(NULL) - seconds}};
    write_text(path, "x");
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

/* What a killed process left beside its target goes with the next write; the files of a process that may
 * still be at work, of another target, and of other names stay. */
static void test_stale_temporary_files_go(void **state)
{
    (void)state;
    static const char *const stays[] = {FOLDER "/a.png.Young1.tmp", FOLDER "/b.png.Stale1.tmp",
                                        FOLDER "/a.png.Stale.tmp", FOLDER "/a.png.my-own.tmp",
                                        FOLDER "/a.pngxStale1.tmp"};
    set_age(FOLDER "/a.png.Stale1.tmp", 4000);
    set_age(stays[0], 3000);
    for (size_t i = 1; i < TL_COUNT(stays); i++)
        set_age(stays[i], 4000);
    write_text(FOLDER "/a.png", "new");
    assert_false(tl_file_exists(FOLDER "/a.png.Stale1.tmp"));
    for (size_t i = 0; i < TL_COUNT(stays); i++)
        assert_true(tl_file_exists(stays[i]));
}

static void test_abandoned_write_leaves_the_old_file(void **state)
{
    (void)state;
    write_text(FOLDER "/a", "old");
    tl_error error = {0};
    struct tl_writer writer;
    assert_ok(tl_writer_begin(&writer, FOLDER "/a", &error), error);
    fputs("new", writer.stream);
    assert_int_equal(count_entries(FOLDER), 2);
    tl_writer_abandon(&writer);
    assert_int_equal(count_entries(FOLDER), 1);
    assert_holds(FOLDER "/a", "old");
    tl_writer_abandon(&writer); /* safe twice */
    tl_writer_abandon(&(struct tl_writer){0});
}

/* Libraries that open files themselves get the temporary name. */
static void test_closed_stream(void **state)
{
    (void)state;
    tl_error error = {0};
    struct tl_writer writer;
    assert_ok(tl_writer_begin(&writer, FOLDER "/a", &error), error);
    tl_writer_close_stream(&writer);
    FILE *library = fopen(writer.temporary, "wb");
    fputs("by a library", library);
    fclose(library);
    assert_ok(tl_writer_commit(&writer, &error), error);
    assert_holds(FOLDER "/a", "by a library");
    assert_ok(tl_writer_begin(&writer, FOLDER "/a", &error), error);
    tl_writer_close_stream(&writer);
    unlink(writer.temporary); /* the library failed and cleaned up after itself */
    assert_false(tl_writer_commit(&writer, &error));
    assert_holds(FOLDER "/a", "by a library");
    assert_int_equal(count_entries(FOLDER), 1);
}

static void test_writing_is_refused(void **state)
{
    (void)state;
    tl_error error = {0};
    struct tl_writer writer;
    write_text(FOLDER "/a", "text");
    assert_false(tl_writer_begin(&writer, "", &error));
    assert_string_equal(error.message, "no output file named: give one with -o");
    assert_false(tl_writer_begin(&writer, FOLDER, &error));
    assert_string_equal(error.message, FOLDER ": is a folder: name a file in it");
    assert_false(tl_writer_begin(&writer, FOLDER "/none/a", &error));
    assert_int_equal(error.code, TL_OUTPUT);
    assert_false(tl_writer_begin(&writer, FOLDER "/a/b", &error));
    assert_int_equal(count_entries(FOLDER), 1);

    assert_ok(tl_writer_begin(&writer, "/dev/full", &error), error); /* a device is written directly */
    fputs("text", writer.stream);
    assert_false(tl_writer_commit(&writer, &error));
    assert_string_equal(error.message,
                        "/dev/full: could not be written whole: No space left on device: free some "
                        "space or choose another place");
    write_text("/dev/null", "text");
    struct stat status;
    assert_int_equal(stat("/dev/null", &status), 0);
    assert_true(S_ISCHR(status.st_mode)); /* not replaced by a renamed file */
}

/* A full disk, simulated by a limit on file sizes in a child process. */
static void test_full_disk_leaves_the_old_file(void **state)
{
    (void)state;
    write_text(FOLDER "/a", "old");
    pid_t child = fork();
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){4096, 4096});
        struct tl_writer writer;
        tl_error error = {0};
        bool begun = tl_writer_begin(&writer, FOLDER "/a", &error);
        for (int i = 0; begun && i < 100000; i++)
            fputs("more than fits", writer.stream);
        _exit(begun && !tl_writer_commit(&writer, &error) && strstr(error.message, "File too large") ? 0 : 1);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    assert_holds(FOLDER "/a", "old");
    assert_int_equal(count_entries(FOLDER), 1);
}

static void test_folders(void **state)
{
    (void)state;
    tl_error error = {0};
    write_text(FOLDER "/a", "text");
    assert_ok(tl_folder_make(FOLDER "/x/y/z", &error), error);
    assert_ok(tl_folder_make(FOLDER "/x/y/z/", &error), error);
    assert_ok(tl_folder_make("/", &error), error);
    assert_false(tl_folder_make("", &error));
    assert_false(tl_folder_make(FOLDER "/a", &error));
    assert_string_equal(error.message, FOLDER "/a: is a file, not a folder: choose another name");
    assert_false(tl_folder_make(FOLDER "/a/b", &error));
}

#define SURVIVED 7

/* A program that is interrupted twice while it writes a file; its exit status. */
static int interrupt_twice(int pause_ms)
{
    pid_t child = fork();
    if (child == 0) {
        struct tl_writer writer;
        tl_interrupt_install();
        if (!tl_writer_begin(&writer, FOLDER "/a", NULL) || tl_interrupted())
            _exit(1);
        fputs("half", writer.stream);
        fflush(writer.stream);
        raise(SIGINT);
        if (!tl_interrupted() || count_entries(FOLDER) != 1)
            _exit(2); /* the first only sets a flag */
        usleep((useconds_t)pause_ms * 1000);
        raise(SIGINT);
        tl_writer_abandon(&writer);
        _exit(SURVIVED);
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(count_entries(FOLDER), 0);
    return WEXITSTATUS(status);
}

/* The second Ctrl-C ends the program, with status 130 and without its temporary files; the echo of the first,
 * which `timeout` sends to the process group, does not. */
static void test_second_interrupt_cleans_up(void **state)
{
    (void)state;
    assert_int_equal(interrupt_twice(TL_INTERRUPT_TWICE_MS + 50), tl_exit_status(TL_INTERRUPTED));
    assert_int_equal(interrupt_twice(0), SURVIVED);
}

static void test_path_extension(void **state)
{
    (void)state;
    assert_true(tl_path_has_extension("a/b.GLB", "glb"));
    assert_false(tl_path_has_extension("a.glb/b", "glb"));
    assert_false(tl_path_has_extension("glb", "glb"));
    assert_false(tl_path_has_extension("", "glb"));
}

/* A message is one line whatever a name contains, and a long one is truncated. */
static void test_messages_are_one_line(void **state)
{
    (void)state;
    tl_error error = {0};
    assert_false(tl_fail(&error, TL_INPUT, "%s: bad", "a\nb\033[2J\tc"));
    assert_string_equal(error.message, "a?b?[2J?c: bad");
    char *longest = tl_alloc(5000, 1);
    memset(longest, 'x', 4999);
    assert_false(tl_fail(&error, TL_INPUT, "%s", longest));
    assert_int_equal(strlen(error.message), sizeof error.message - 1);
    assert_false(tl_fail(NULL, TL_INPUT, "nobody listens"));
    free(longest);
}

/* Embedded data equal their files, and each list of names matches its files. */
static void test_embedded_files(void **state)
{
    (void)state;
    const struct tl_embedded *const lists[] = {tl_embedded_presets, tl_embedded_scenes, tl_embedded_fabrics};
    const char *const *const names[] = {tl_embedded_presets_names, tl_embedded_scenes_names,
                                        tl_embedded_fabrics_names};
    for (size_t i = 0; i < TL_COUNT(lists); i++) {
        size_t count = 0;
        for (; lists[i][count].name; count++) {
            const struct tl_embedded *entry = &lists[i][count];
            assert_int_equal(entry->size, strlen(entry->data));
            assert_holds(entry->source, entry->data);
            char *file = tl_format("%s.yaml", names[i][count]);
            assert_ptr_equal(tl_embedded_find(lists[i], file), entry);
            free(file);
        }
        assert_true(count >= 2);
        assert_null(names[i][count]);
        assert_null(tl_embedded_find(lists[i], "none such.yaml"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_write_and_read, begin),
        cmocka_unit_test_setup(test_reading_is_refused, begin),
        cmocka_unit_test_setup(test_stale_temporary_files_go, begin),
        cmocka_unit_test_setup(test_abandoned_write_leaves_the_old_file, begin),
        cmocka_unit_test_setup(test_closed_stream, begin),
        cmocka_unit_test_setup(test_writing_is_refused, begin),
        cmocka_unit_test_setup(test_full_disk_leaves_the_old_file, begin),
        cmocka_unit_test_setup(test_folders, begin),
        cmocka_unit_test_setup(test_second_interrupt_cleans_up, begin),
        cmocka_unit_test(test_path_extension),
        cmocka_unit_test(test_messages_are_one_line),
        cmocka_unit_test(test_embedded_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
