/* The C library's functions that give memory, for the whole program, the libraries that it uses included:
 * when one of them fails, the program ends as it does for tl_alloc (config/base/memory.h). Otherwise a
 * failure would end in whatever each library makes of it: a crash inside the GL driver, an abort, an exit
 * status of 1.
 *
 * The program's definitions take the place of the C library's in every shared library (glibc manual,
 * "Replacing malloc"); the memory is still the C library's own, so free() stays its own too. Sanitizers
 * define these functions themselves. */
#include "config/base/memory.h"

#include <dlfcn.h>
#include <errno.h>
#include <malloc.h>
#include <stdlib.h>
#include <sys/mman.h>

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(__clang__)

/* Declared by no header of glibc, but exported by it. */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

/* Seen by the libraries, although names are hidden as a rule (CMakeLists.txt). */
#define REPLACES __attribute__((weak, visibility("default")))

static void *or_end(void *memory, size_t size)
{
    if (!memory && size > 0)
        tl_memory_exhausted(size);
    return memory;
}

REPLACES void *malloc(size_t size)
{
    return or_end(__libc_malloc(size), size);
}

REPLACES void *calloc(size_t count, size_t size)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes))
        bytes = SIZE_MAX;
    return or_end(__libc_calloc(count, size), bytes);
}

REPLACES void *realloc(void *memory, size_t size)
{
    return or_end(__libc_realloc(memory, size), size);
}

REPLACES void *aligned_alloc(size_t alignment, size_t size)
{
    return or_end(__libc_memalign(alignment, size), size);
}

/* OpenMP's. */
REPLACES void *memalign(size_t alignment, size_t size)
{
    return aligned_alloc(alignment, size);
}

REPLACES int posix_memalign(void **out, size_t alignment, size_t size)
{
    if (alignment == 0 || alignment % sizeof(void *) != 0 || (alignment & (alignment - 1)) != 0)
        return EINVAL;
    *out = aligned_alloc(alignment, size);
    return 0;
}

/* LLVM, which compiles the shaders of GL in software, takes its memory from the system, and aborts without.
 * Huge pages are only tried. */
REPLACES void *mmap(void *address, size_t size, int protection, int flags, int file, off_t offset)
{
    __typeof__(&mmap) next = (__typeof__(next))(size_t)dlsym(RTLD_NEXT, "mmap");
    void *memory = next(address, size, protection, flags, file, offset);
    if (memory == MAP_FAILED && errno == ENOMEM && (flags & MAP_ANONYMOUS) && !(flags & MAP_HUGETLB))
        tl_memory_exhausted(size);
    return memory;
}

/* Calls of libraries that were compiled for files beyond 2 GB. */
REPLACES void *mmap64(void *address, size_t size, int protection, int flags, int file, off_t offset)
{
    return mmap(address, size, protection, flags, file, offset);
}

#endif
