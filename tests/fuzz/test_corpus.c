/* The kept corpus of `./dev fuzz` through every reader, in an ordinary build: an input that once broke a
 * reader does so again when its repair is lost. The seeds, whose names begin with "seed", must be read: a
 * reader that refuses everything would pass all the rest. */
#include "config/base/file.h"
#include "config/base/memory.h"
#include "tests/fuzz/readers.h"
#include "tests/testing.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>

#define CORPUS TOILE_SOURCE_DIR "/tests/fuzz/corpus"

static bool replay(const struct fuzz_reader *reader, const char *name)
{
    char *path = tl_format(CORPUS "/%s/%s", reader->name, name), *bytes;
    size_t size;
    tl_error error = {0};
    printf("%s/%s\n", reader->name, name); /* the last line before a crash names its input */
    fflush(stdout);
    assert_ok(tl_file_read(path, &bytes, &size, &error), error);
    bool is_read = fuzz_read(reader, bytes, size);
    free(bytes);
    free(path);
    return is_read;
}

static void the_corpus_is_read(void **state)
{
    (void)state;
    for (const struct fuzz_reader *reader = fuzz_readers; reader->name; reader++) {
        char *folder = tl_format(CORPUS "/%s", reader->name);
        struct dirent **entries;
        int count = scandir(folder, &entries, NULL, alphasort), seeds = 0;
        free(folder);
        assert_true(count > 0);
        for (int i = 0; i < count; i++) {
            if (entries[i]->d_name[0] != '.') {
                bool is_seed = strncmp(entries[i]->d_name, "seed", 4) == 0;
                bool is_read = replay(reader, entries[i]->d_name);
                if (is_seed && !is_read)
                    fail_msg("%s/%s: is refused", reader->name, entries[i]->d_name);
                seeds += is_seed;
            }
            free(entries[i]);
        }
        free(entries);
        assert_true(seeds > 0);
    }
}

static int begin(void **state)
{
    (void)state;
    fuzz_begin();
    return 0;
}

static int end(void **state)
{
    (void)state;
    fuzz_end();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_corpus_is_read)};
    return cmocka_run_group_tests(tests, begin, end);
}
