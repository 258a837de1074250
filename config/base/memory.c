#include "config/base/memory.h"

#include <inttypes.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void tl_memory_exhausted(size_t bytes)
{
    tl_end_program("out of memory: %zu bytes were refused by the system: close other programs, or take "
                   "smaller images and meshes",
                   bytes);
}

static void *insist(void *memory, size_t count, size_t size)
{
    size_t bytes;
    if (!memory)
        tl_memory_exhausted(__builtin_mul_overflow(count, size, &bytes) ? SIZE_MAX : bytes);
    return memory;
}

void *tl_alloc(size_t count, size_t size)
{
    return insist(calloc(count ? count : 1, size), count, size);
}

void *tl_alloc_lines(size_t count, size_t size)
{
    size_t bytes;
    bool fits = !__builtin_mul_overflow(count ? count : 1, size, &bytes) &&
                !__builtin_add_overflow(bytes, TL_CACHE_LINE - 1, &bytes);
    bytes -= bytes % TL_CACHE_LINE; /* whole lines, as aligned_alloc asks */
    void *memory = insist(fits ? aligned_alloc(TL_CACHE_LINE, bytes) : NULL, count, size);
    return memset(memory, 0, bytes);
}

void *tl_resize(void *memory, size_t count, size_t size)
{
    return insist(reallocarray(memory, count ? count : 1, size), count, size);
}

char *tl_copy_string(const char *text)
{
    return insist(strdup(text), strlen(text), 1);
}

char *tl_format(const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    return insist(length < 0 ? NULL : text, 1, 1);
}

/* ---- The allowance ---- */

static uint64_t allowed_bytes;
static bool is_set_by_user;

/* A control group's limit is a number of bytes, or "max". */
static uint64_t limit_in(const char *path)
{
    uint64_t limit = UINT64_MAX;
    FILE *stream = fopen(path, "r");
    if (stream && fscanf(stream, "%" SCNu64, &limit) != 1)
        limit = UINT64_MAX;
    if (stream)
        fclose(stream);
    return limit;
}

/* The lowest limit of a group and those above it. In a container the group's own path may not be visible, but
 * the root then is the container's group. */
static uint64_t limit_upwards(const char *root, const char *group, const char *file)
{
    uint64_t lowest = UINT64_MAX;
    char path[PATH_MAX];
    for (size_t length = strlen(group);; length--) {
        if (length > 0 && group[length] != '/' && group[length] != '\0')
            continue;
        snprintf(path, sizeof path, "%s%.*s/%s", root, (int)length, group, file);
        uint64_t limit = limit_in(path);
        lowest = limit < lowest ? limit : lowest;
        if (length == 0)
            return lowest;
    }
}

/* A line is "0::GROUP" in version 2, and "NUMBER:CONTROLLERS:GROUP" in version 1 (cgroups(7)). */
uint64_t tl_memory_cgroup_limit(const char *cgroups, const char *root)
{
    uint64_t lowest = UINT64_MAX;
    char line[PATH_MAX], version_1[PATH_MAX];
    snprintf(version_1, sizeof version_1, "%s/memory", root);
    for (const char *at = cgroups; *at; at += strcspn(at, "\n"), at += *at == '\n') {
        snprintf(line, sizeof line, "%.*s", (int)strcspn(at, "\n"), at);
        char *controllers = strchr(line, ':'), *group = controllers ? strchr(controllers + 1, ':') : NULL;
        if (!group)
            continue;
        *group++ = '\0';
        uint64_t limit = UINT64_MAX;
        if (strcmp(controllers, ":") == 0)
            limit = limit_upwards(root, group, "memory.max");
        else if (strstr(controllers, "memory"))
            limit = limit_upwards(version_1, group, "memory.limit_in_bytes");
        lowest = limit < lowest ? limit : lowest;
    }
    return lowest;
}

static uint64_t find_allowance(void)
{
    char cgroups[4096] = "";
    FILE *stream = fopen("/proc/self/cgroup", "r");
    if (stream) {
        cgroups[fread(cgroups, 1, sizeof cgroups - 1, stream)] = '\0';
        fclose(stream);
    }
    uint64_t machine = (uint64_t)sysconf(_SC_PHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE);
    uint64_t group = tl_memory_cgroup_limit(cgroups, "/sys/fs/cgroup");
    uint64_t bytes = group < machine ? group : machine;
    return bytes - bytes / 8;
}

void tl_memory_allow(uint64_t bytes)
{
    is_set_by_user = bytes > 0;
    allowed_bytes = is_set_by_user ? bytes : find_allowance();
}

uint64_t tl_memory_allowed(void)
{
    if (allowed_bytes == 0)
        tl_memory_allow(0);
    return allowed_bytes;
}

static uint64_t resident_bytes(void)
{
    uint64_t pages = 0;
    FILE *stream = fopen("/proc/self/statm", "r");
    if (stream && fscanf(stream, "%*u %" SCNu64, &pages) != 1)
        pages = 0;
    if (stream)
        fclose(stream);
    return pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

struct amount {
    char text[32];
};

static struct amount amount_of(uint64_t bytes)
{
    struct amount amount;
    double mib = (double)bytes / (1 << 20);
    if (mib < 1000)
        snprintf(amount.text, sizeof amount.text, "%.0f MiB", mib);
    else
        snprintf(amount.text, sizeof amount.text, "%.1f GiB", mib / 1024);
    return amount;
}

bool tl_memory_request(const char *what, uint64_t bytes, tl_error *error)
{
    uint64_t allowed = tl_memory_allowed(), resident = resident_bytes();
    if (resident <= allowed && bytes <= allowed - resident)
        return true;
    return tl_fail(
        error, TL_INPUT,
        "%s: needs %s of %s allowed, of which %s are in use: make it smaller, or allow more with --memory",
        what, amount_of(bytes).text, amount_of(allowed).text, amount_of(resident).text);
}

bool tl_memory_request_for_file(const char *name, size_t file_bytes, uint64_t bytes, tl_error *error)
{
    const uint64_t small = 1 << 20;
    uint64_t of_file = TL_MEMORY_OF_SMALL / small * (file_bytes > small ? file_bytes : small);
    if (!is_set_by_user && bytes > of_file)
        return tl_fail(
            error, TL_INPUT,
            "%s: needs %s, but %s are allowed for a file of %.1f MiB: make it smaller, or allow more with "
            "--memory",
            name, amount_of(bytes).text, amount_of(of_file).text, (double)file_bytes / (double)small);
    return tl_memory_request(name, bytes, error);
}
