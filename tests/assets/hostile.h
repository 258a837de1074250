/* Shared by tests of broken files: a file is loaded, or refused with one line that names it; nothing crashes,
 * and no small file takes much memory. */
#ifndef TOILE_TESTS_HOSTILE_H
#define TOILE_TESTS_HOSTILE_H

#include "config/base/error.h"
#include "config/base/memory.h"

#include "tests/testing.h"

#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

#define SCRATCH TOILE_SCRATCH_DIR "/hostile"

struct outcome {
    size_t loaded, refused;
};

static inline void count_outcome(struct outcome *outcome, const char *path, bool loaded,
                                 const tl_error *error)
{
    outcome->loaded += loaded;
    outcome->refused += !loaded;
    if (loaded)
        return;
    const char *slash = strrchr(path, '/');
    if (error->code != TL_INPUT || !strstr(error->message, slash + 1) || strchr(error->message, '\n')) {
        print_error("%s: refused with \"%s\"\n", path, error->message);
        fail();
    }
}

typedef bool (*try_function)(struct outcome *, const char *);

static inline void report(const char *what, struct outcome outcome)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    printf("%s: %zu loaded, %zu refused; peak so far %ld MiB\n", what, outcome.loaded, outcome.refused,
           usage.ru_maxrss / 1024);
#ifndef __SANITIZE_ADDRESS__
    /* A small file may claim up to 2^22 texels before its length is checked: 64 MiB of colour, as much again
     * while it is copied or decoded, and what the process had. */
    assert_true(usage.ru_maxrss < 512L * 1024);
#endif
}

static inline void scratch_write(const char *path, const void *bytes, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    // cppcheck-suppress uninitvar ; a false finding: it loses what the caller wrote
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

static inline const char *scratch(const char *name)
{
    static char path[1024];
    mkdir(SCRATCH, 0777);
    snprintf(path, sizeof path, SCRATCH "/%s", name);
    return path;
}

/* ---- Random damage with a fixed seed ---- */

static inline uint32_t next_random(uint32_t *seed)
{
    *seed ^= *seed << 13, *seed ^= *seed >> 17, *seed ^= *seed << 5; /* Marsaglia's xorshift32 */
    return *seed;
}

/* A digit is replaced by another: the file still parses, with false numbers. */
static inline uint8_t damaged(uint8_t byte, bool text, uint32_t *seed)
{
    if (text)
        return byte >= '0' && byte <= '9' ? (uint8_t)('0' + next_random(seed) % 10) : byte;
    uint32_t any = next_random(seed), bit = 1u << next_random(seed) % 8;
    return (uint8_t)(any & 0x100 ? any : byte ^ bit);
}

/* Loads `count` copies of a file, each with a few bytes changed; `text`: only digits, and more of them. */
static inline void mutate(const char *name, const uint8_t *bytes, size_t size, int count, bool text,
                          try_function try)
{
    const char *path = scratch(name);
    uint32_t seed = 20240229;
    struct outcome outcome = {0};
    uint8_t *copy = TL_NEW_ARRAY(uint8_t, size);
    for (int i = 0; i < count; i++) {
        memcpy(copy, bytes, size);
        for (uint32_t changes = 1 + next_random(&seed) % (text ? 16 : 4); changes > 0; changes--) {
            uint32_t at = next_random(&seed) % (uint32_t)size;
            copy[at] = damaged(copy[at], text, &seed);
        }
        scratch_write(path, copy, size);
        try(&outcome, path);
    }
    free(copy);
    report(name, outcome);
}

static inline void mutate_file(const char *from, const char *name, int count, try_function try)
{
    static uint8_t bytes[1 << 20];
    FILE *stream = fopen(from, "rb");
    assert_non_null(stream);
    size_t size = fread(bytes, 1, sizeof bytes, stream);
    fclose(stream);
    assert_true(size < sizeof bytes);
    mutate(name, bytes, size, count, false, try);
}

#endif
