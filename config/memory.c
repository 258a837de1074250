#include "config/memory.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *insist(void *memory, size_t count, size_t size)
{
    if (!memory) {
        fprintf(stderr, "toile: out of memory: %zu x %zu bytes were refused by the system\n", count, size);
        abort();
    }
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
