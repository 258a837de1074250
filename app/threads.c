/* The C library's functions that start threads, for the whole program, the libraries that it uses included:
 * when the system refuses a thread, the program ends as it does for memory (app/allocation.c). Otherwise
 * OpenMP would print a message of its own and exit with status 1, Embree would abort, and GL in software
 * would wait for threads that never began. */
#include "config/base/error.h"

#include <dlfcn.h>
#include <pthread.h>
#include <string.h>
#include <threads.h>

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(__clang__)

/* The same as in app/allocation.c. */
#define REPLACES __attribute__((weak, visibility("default")))

/* The C library's own. */
#define NEXT(name) ((__typeof__(&name))(size_t)dlsym(RTLD_NEXT, #name))

__attribute__((noreturn)) static void end(const char *reason)
{
    tl_end_program("a thread could not be started: %s: close other programs, or lower OMP_NUM_THREADS",
                   reason);
}

REPLACES int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *),
                            void *argument)
{
    int reason = NEXT(pthread_create)(thread, attributes, run, argument);
    if (reason != 0)
        end(strerror(reason));
    return 0;
}

REPLACES int thrd_create(thrd_t *thread, thrd_start_t run, void *argument)
{
    int result = NEXT(thrd_create)(thread, run, argument);
    if (result != thrd_success)
        end("too many threads, or too little memory");
    return result;
}

#endif
