/* Preloaded into toile by test_inject: a clock that makes runs repeatable, and refusals that no system call
 * shows. The program itself has nothing of it.
 *
 *   INJECT_MEMORY=K    every K-th allocation of the process, those of its libraries included, is refused,
 * each in a copy of the process (fork) that goes no further than its end. The copy's files are the process's
 * own, so what it would remove stays, and what it would print is only compared: one line, exit status 2, no
 * temporary file left. INJECT_GL=N        interpose_gl.c: the N-th call is refused; 0 only counts.
 *   INJECT_REPORT=FILE gets one line at the end: calls, copies that ended otherwise than they should, number
 *                      of the first one and what was wrong with it.
 *
 * Threads: toile must run with OMP_NUM_THREADS=1 and LP_NUM_THREADS=0; then calls are numbered alike in each
 * run. */
#include "tests/app/inject/interpose.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* The function that the program would call without this library. */
static void *next(const char *name)
{
    return dlsym(RTLD_NEXT, name);
}
#define NEXT(name) ((__typeof__(&name))(size_t)next(#name))

struct inject_account inject_account;

long inject_number(const char *variable)
{
    const char *text = getenv(variable);
    return text ? atol(text) : -1;
}

__attribute__((destructor)) static void report(void)
{
    const char *path = getenv("INJECT_REPORT");
    int file = path ? (int)syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
    if (file >= 0)
        dprintf(file, "%ld %ld %ld %s\n", inject_account.calls, inject_account.bad, inject_account.first_bad,
                inject_account.problem ? inject_account.problem : "-");
}

/* ---- Clock: a microsecond passes with each call, so that times in files and decisions that follow from
 * times are the same in each run. Threads wait by the system's own. ---- */

int clock_gettime(clockid_t clock, struct timespec *time)
{
    static long now_us;
    (void)clock;
    long us = __atomic_add_fetch(&now_us, 1, __ATOMIC_RELAXED);
    *time = (struct timespec){1700000000 + us / 1000000, us % 1000000 * 1000};
    return 0;
}

/* Flights record the machine's load. */
int getloadavg(double loads[], int count)
{
    for (int i = 0; i < count; i++)
        loads[i] = 0;
    return count;
}

/* ---- Memory ---- */

#define TEMPORARIES 64
static char temporaries[TEMPORARIES][PATH_MAX]; /* files that exist and wait to be renamed */
static int is_copy, lines;

static char *slot_of(const char *path)
{
    for (int i = 0; i < TEMPORARIES; i++)
        if (strcmp(temporaries[i], path) == 0)
            return temporaries[i];
    return NULL;
}

int mkstemps(char *name, int suffix)
{
    int file = NEXT(mkstemps)(name, suffix);
    char *slot = slot_of("");
    if (file >= 0 && slot && strlen(name) < PATH_MAX)
        strcpy(slot, name);
    return file;
}

int rename(const char *from, const char *to)
{
    int result = NEXT(rename)(from, to);
    char *slot = slot_of(from);
    if (slot && result == 0)
        slot[0] = '\0';
    return result;
}

int unlink(const char *path)
{
    int result = is_copy ? 0 : NEXT(unlink)(path);
    char *slot = slot_of(path);
    if (slot && result == 0)
        slot[0] = '\0';
    return result;
}

ssize_t write(int file, const void *bytes, size_t size)
{
    if (!is_copy)
        return syscall(SYS_write, file, bytes, size);
    const char *text = bytes;
    if (file != STDERR_FILENO || size == 0 || text[size - 1] != '\n')
        lines += 2; /* neither is any of them a line alone */
    for (size_t i = 0; i < size; i++)
        lines += text[i] == '\n';
    return (ssize_t)size;
}

/* How a copy ended. */
enum { ENDED_WELL, ENDED_STATUS, ENDED_LINES, ENDED_TEMPORARY, ENDED_KINDS };
static const char *const problems[ENDED_KINDS] = {"", "exit status", "not one line", "temporary file left"};

void _exit(int status)
{
    if (is_copy) {
        int left = 0;
        for (int i = 0; i < TEMPORARIES; i++)
            left |= temporaries[i][0] != '\0';
        status = status != 2 ? ENDED_STATUS : lines != 1 ? ENDED_LINES : left ? ENDED_TEMPORARY : ENDED_WELL;
    }
    for (;;)
        syscall(SYS_exit_group, status);
}

/* Whether this process is a copy in which the allocation is to fail. An allocation of no bytes may give NULL
 * at any time: it is none. */
static int is_refused(size_t bytes)
{
    static long stride = -2;
    if (stride == -2)
        stride = inject_number("INJECT_MEMORY");
    if (stride <= 0 || bytes == 0 || is_copy || ++inject_account.calls % stride != 0)
        return 0;
    int reason = errno, status = 0;
    pid_t copy = _Fork();
    if (copy == 0) {
        is_copy = 1;
        errno = ENOMEM;
        return 1;
    }
    if (copy > 0)
        waitpid(copy, &status, 0);
    if (copy < 0 || status != 0) {
        inject_account.first_bad =
            inject_account.bad++ == 0 ? inject_account.calls : inject_account.first_bad;
        int how = copy > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : ENDED_KINDS;
        if (inject_account.bad == 1)
            inject_account.problem = how < ENDED_KINDS ? problems[how] : "no exit";
    }
    errno = reason;
    return 0;
}

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

void *__libc_malloc(size_t size)
{
    static __typeof__(&__libc_malloc) real;
    if (!real)
        real = NEXT(__libc_malloc);
    return is_refused(size) ? NULL : real(size);
}

void *__libc_calloc(size_t count, size_t size)
{
    static __typeof__(&__libc_calloc) real;
    if (!real)
        real = NEXT(__libc_calloc);
    return is_refused(count * size) ? NULL : real(count, size);
}

void *__libc_realloc(void *memory, size_t size)
{
    static __typeof__(&__libc_realloc) real;
    if (!real)
        real = NEXT(__libc_realloc);
    return is_refused(size) ? NULL : real(memory, size);
}

void *__libc_memalign(size_t alignment, size_t size)
{
    static __typeof__(&__libc_memalign) real;
    if (!real)
        real = NEXT(__libc_memalign);
    return is_refused(size) ? NULL : real(alignment, size);
}
