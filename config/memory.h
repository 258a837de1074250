/* Memory. Out of memory aborts with a message: no caller has a way to continue. Sizes that come from a
 * file must be checked against the file's own length or TL_LIMIT_* before they reach these functions. */
#ifndef TOILE_CONFIG_MEMORY_H
#define TOILE_CONFIG_MEMORY_H

#include <stddef.h>

/* Zeroed array of `count` elements of `size` bytes; free() releases it. Never NULL, also for count 0. */
void *tl_alloc(size_t count, size_t size);

/* The same, aligned to a cache line: aligned vector loads then never straddle two lines. */
#define TL_CACHE_LINE 64
void *tl_alloc_lines(size_t count, size_t size);

/* realloc of an array to `count` elements; new memory is not zeroed. Never NULL. */
void *tl_resize(void *memory, size_t count, size_t size);

/* Copy of a string; never NULL. */
char *tl_copy_string(const char *text);

/* printf into a new string; never NULL. */
char *tl_format(const char *format, ...) __attribute__((format(printf, 1, 2)));

#define TL_NEW(type)              ((type *)tl_alloc(1, sizeof(type)))
#define TL_NEW_ARRAY(type, count) ((type *)tl_alloc((count), sizeof(type)))
#define TL_COUNT(array)           (sizeof(array) / sizeof((array)[0]))

#endif
