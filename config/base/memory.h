/* Memory: allocation that never fails, and the allowance that large amounts are asked of first.
 *
 * Out of memory ends the program: one line, exit status 2, and no temporary file is left, because no caller
 * has a way to continue. Sizes that come from a file or an option must be checked against TL_LIMIT_*, or
 * asked for with tl_memory_request or tl_memory_request_for_file, before they reach the allocating functions.
 * Threads: any. */
#ifndef TOILE_CONFIG_BASE_MEMORY_H
#define TOILE_CONFIG_BASE_MEMORY_H

#include "config/base/error.h"

#include <stddef.h>
#include <stdint.h>

/* Zeroed array of `count` elements of `size` bytes; free() releases it. Never NULL, also for count 0. */
void *tl_alloc(size_t count, size_t size);

/* The same, aligned to a cache line: aligned vector loads then never straddle two lines. */
#define TL_CACHE_LINE 64
void *tl_alloc_lines(size_t count, size_t size);

/* realloc of an array to `count` elements; new memory is not zeroed. Never NULL. */
void *tl_resize(void *memory, size_t count, size_t size);

/* The elements for which an array of `count` is given room: so many at first, as for a still image, and a
 * quarter more once it has grown, because it may grow again. */
static inline size_t tl_room_for(size_t count, size_t capacity)
{
    return count <= capacity ? capacity : capacity > 0 ? count + count / 4 : count;
}

/* Copy of a string; never NULL. */
char *tl_copy_string(const char *text);

/* printf into a new string; never NULL. */
char *tl_format(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Ends the program (tl_end_program). Allocates nothing. */
void tl_memory_exhausted(size_t bytes) __attribute__((noreturn));

/* ---- The allowance: bytes that the process may take ---- */

/* Sets it, before threads start. 0: seven eighths of the memory of the machine, or of the container where
 * that has less; the rest is left to the system and to what is taken without being asked for. */
void tl_memory_allow(uint64_t bytes);
uint64_t tl_memory_allowed(void);

/* Whether the process may take `bytes` more than it has resident. False, with a line that names `what`, how
 * much it needs and how much is allowed (TL_INPUT). Nothing is reserved. */
bool tl_memory_request(const char *what, uint64_t bytes, tl_error *error);

/* The same for what a file of `file_bytes` becomes in memory, copies that exist at the same time included.
 * Unless the user has set the allowance, a file may also become at most TL_MEMORY_OF_SMALL bytes if it is
 * smaller than a mebibyte, and as many times its size if it is larger: a small file costs little, whatever it
 * claims. */
#define TL_MEMORY_OF_SMALL ((uint64_t)128 << 20)
bool tl_memory_request_for_file(const char *name, size_t file_bytes, uint64_t bytes, tl_error *error);

/* The limit of a process by the text of its /proc/self/cgroup: the lowest of its control group (version 1 or
 * 2) and those above, whose files are below `root` ("/sys/fs/cgroup"). UINT64_MAX: no limit. */
uint64_t tl_memory_cgroup_limit(const char *cgroups, const char *root);

#define TL_NEW(type)              ((type *)tl_alloc(1, sizeof(type)))
#define TL_NEW_ARRAY(type, count) ((type *)tl_alloc((count), sizeof(type)))
#define TL_COUNT(array)           (sizeof(array) / sizeof((array)[0]))

#endif
