/* The cache of drapes: what is stored is what is loaded; damaged files are discarded; writers do not disturb
 * one another; the least recently used files go first; a folder that cannot be written is no error. */
#include "tests/testing.h"

#include "config/base/file.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "config/cache/cache.h"

#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>

static char *folder; /* of this test alone */

static int make_folder(void **state)
{
    (void)state;
    char name[] = TOILE_SCRATCH_DIR "/cache_XXXXXX";
    folder = tl_format("%s/toile/drapes", mkdtemp(name));
    tl_cache_use(folder, 1 << 20);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    tl_cache_use(NULL, 0);
    tl_cache_clear(folder);
    for (int i = 0; i < 3; i++) { /* drapes, toile and the scratch folder */
        rmdir(folder);
        *strrchr(folder, '/') = '\0';
    }
    free(folder);
    return 0;
}

static struct tl_cache_key key_of(int number)
{
    struct tl_cache_key key = tl_cache_key_begin();
    tl_cache_key_add(&key, &number, sizeof number);
    return key;
}

static bool holds(int number, const char *text)
{
    struct tl_cache_key key = key_of(number);
    void *data;
    size_t size;
    if (!tl_cache_load(&key, &data, &size))
        return false;
    assert_int_equal(size, strlen(text));
    assert_memory_equal(data, text, size);
    free(data);
    return true;
}

static void store(int number, const char *text)
{
    struct tl_cache_key key = key_of(number);
    tl_cache_store(&key, text, strlen(text));
}

static void stored_bytes_are_loaded(void **state)
{
    (void)state;
    assert_false(holds(1, ""));
    store(1, "one");
    store(2, "two");
    assert_true(holds(1, "one"));
    assert_true(holds(2, "two"));
    store(1, "another");
    assert_true(holds(1, "another"));
    char text[8];
    struct tl_cache_key key = key_of(2);
    assert_true(tl_cache_read(&key, text, 3));
    assert_memory_equal(text, "two", 3);
    assert_false(tl_cache_read(&key, text, 2)); /* of another size: no part of it */
    assert_false(tl_cache_read(&key, text, 4));
    size_t count;
    struct tl_cache_entry *entries = tl_cache_list(folder, &count);
    assert_int_equal(count, 2);
    free(entries);
    assert_int_equal(tl_cache_clear(folder), 2);
    assert_false(holds(1, ""));
    tl_cache_use(NULL, 0);
    store(1, "one");
    assert_false(holds(1, "one"));
    tl_cache_use(folder, 1 << 20);
    assert_false(holds(1, "one"));
}

/* Keys differ when bytes move from one addition to the next. */
static void keys_know_where_additions_end(void **state)
{
    (void)state;
    struct tl_cache_key a = tl_cache_key_begin(), b = tl_cache_key_begin();
    tl_cache_key_add(&a, "ab", 2);
    tl_cache_key_add(&a, "c", 1);
    tl_cache_key_add(&b, "a", 1);
    tl_cache_key_add(&b, "bc", 2);
    assert_int_not_equal(a.words[0], b.words[0]);
    assert_int_not_equal(a.words[1], b.words[1]);
}

/* The only file there is. */
static char *only_file(void)
{
    size_t count;
    struct tl_cache_entry *entries = tl_cache_list(folder, &count);
    assert_int_equal(count, 1);
    char *path = tl_format("%s/%s", folder, entries[0].name);
    free(entries);
    return path;
}

static void damaged_files_are_discarded(void **state)
{
    (void)state;
    store(1, "some bytes");
    char *path = only_file(), *whole;
    size_t size;
    tl_error error;
    assert_ok(tl_file_read(path, &whole, &size, &error), error);
    tl_log_set_level(TL_LOG_QUIET);               /* one line for each */
    for (size_t kept = 0; kept <= size; kept++) { /* shortened to each length, or with one byte changed */
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        char *copy = tl_alloc(size, 1);
        memcpy(copy, whole, size);
        if (kept == size)
            copy[size - 1] ^= 1;
        fwrite(copy, 1, kept, file);
        fclose(file);
        free(copy);
        assert_false(holds(1, "some bytes"));
        assert_false(tl_file_exists(path));
    }
    for (size_t at = 0; at < size; at++) {
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        fwrite(whole, 1, size, file);
        fseek(file, (long)at, SEEK_SET);
        fputc(whole[at] ^ 0x40, file);
        fclose(file);
        assert_false(holds(1, "some bytes"));
    }
    tl_log_set_level(TL_LOG_INFO);
    store(1, "some bytes");
    assert_true(holds(1, "some bytes"));
    free(whole);
    free(path);
}

/* Two processes write and read the same keys: what is read is always whole. */
static void writers_do_not_disturb_one_another(void **state)
{
    (void)state;
    static const char *const texts[] = {"short", "a text that is longer than the other one"};
    pid_t child = fork();
    assert_true(child >= 0);
    bool good = true;
    for (int i = 0; i < 400; i++) {
        struct tl_cache_key key = key_of(i % 3);
        void *data;
        size_t size;
        const char *own = texts[child == 0];
        tl_cache_store(&key, own, strlen(own));
        if (!tl_cache_load(&key, &data, &size)) {
            good = false;
            continue;
        }
        good = good && (size == strlen(texts[0]) ? memcmp(data, texts[0], size) == 0
                                                 : size == strlen(texts[1]) && !memcmp(data, texts[1], size));
        free(data);
    }
    if (child == 0)
        _exit(good ? 0 : 1);
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    assert_true(good);
    size_t count;
    struct tl_cache_entry *entries = tl_cache_list(folder, &count);
    assert_int_equal(count, 3);
    free(entries);
}

static void the_least_recently_used_go_first(void **state)
{
    (void)state;
    char text[1001] = {0};
    memset(text, 'x', sizeof text - 1);
    tl_cache_use(folder, 3500); /* three files */
    for (int i = 0; i < 3; i++) {
        store(i, text);
        usleep(20000); /* a file system's clock ticks some hundred times a second */
    }
    assert_true(holds(0, text)); /* used now, so that 1 is the oldest */
    usleep(20000);
    store(3, text);
    assert_true(holds(0, text));
    assert_false(holds(1, text));
    assert_true(holds(2, text));
    assert_true(holds(3, text));
    tl_cache_use(folder, 500); /* what is larger than the limit is not kept, and removes nothing */
    store(4, text);
    size_t count;
    struct tl_cache_entry *entries = tl_cache_list(folder, &count);
    assert_int_equal(count, 3);
    free(entries);
}

/* A folder that is a file cannot be written to by anyone, root included. */
static void folders_that_cannot_be_written_are_no_error(void **state)
{
    (void)state;
    char *file = tl_format("%s/blocked", TOILE_SCRATCH_DIR), *inside = tl_format("%s/drapes", file);
    FILE *stream = fopen(file, "wb");
    assert_non_null(stream);
    fclose(stream);
    tl_cache_use(inside, 1 << 20);
    store(1, "one");
    assert_false(holds(1, "one"));
    assert_int_equal(tl_cache_clear(inside), 0);
    unlink(file);
    free(inside);
    free(file);
}

static void the_folder_follows_the_environment(void **state)
{
    (void)state;
    static const struct {
        const char *cache, *home, *expected;
    } cases[] = {
        {"/a/cache", "/home/x", "/a/cache/toile/drapes"},
        {"relative", "/home/x", "/home/x/.cache/toile/drapes"},
        {NULL, "/home/x", "/home/x/.cache/toile/drapes"},
        {NULL, NULL, NULL},
    };
    for (size_t i = 0; i < TL_COUNT(cases); i++) {
        cases[i].cache ? setenv("XDG_CACHE_HOME", cases[i].cache, 1) : unsetenv("XDG_CACHE_HOME");
        cases[i].home ? setenv("HOME", cases[i].home, 1) : unsetenv("HOME");
        char *found = tl_cache_folder();
        if (cases[i].expected)
            assert_string_equal(found, cases[i].expected);
        else
            assert_null(found);
        free(found);
    }
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_FOLDER(stored_bytes_are_loaded),
        cmocka_unit_test(keys_know_where_additions_end),
        IN_FOLDER(damaged_files_are_discarded),
        IN_FOLDER(writers_do_not_disturb_one_another),
        IN_FOLDER(the_least_recently_used_go_first),
        IN_FOLDER(folders_that_cannot_be_written_are_no_error),
        cmocka_unit_test(the_folder_follows_the_environment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
