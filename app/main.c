/* toile COMMAND [SCENE] [OPTIONS]: finds the command, parses its flags, runs it, turns its error into one
 * line. */
#include "app/commands.h"
#include "config/base/interrupt.h"
#include "config/base/memory.h"
#include "render/gpu/gpu.h"

#include <locale.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <unistd.h>

static bool run(int argc, char **argv, tl_error *error)
{
    const char *name = argc > 1 ? argv[1] : "help";
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0)
        name = "help";
    if (strcmp(name, "--version") == 0) {
        printf("toile %s\n", TOILE_VERSION);
        return true;
    }
    const struct tl_command *command = tl_command_find(name, error);
    if (!command)
        return false;
    struct tl_arguments arguments;
    bool done = tl_arguments_parse(argc > 2 ? argc - 2 : 0, argv + 2, command->flags, &arguments, error);
    if (done && arguments.help) {
        done = tl_command_help(&(struct tl_arguments){.positionals = {name}, .positional_count = 1}, error);
    } else if (done) {
        arguments.command_line = argv + 1;
        tl_arguments_apply(&arguments);
        tl_gpu_choose(arguments.device);
        done = command->run(&arguments, error);
    }
    tl_arguments_release(&arguments);
    return done;
}

/* Keeps freed memory in the process. Each frame allocates again what the last one freed, in other sizes when
 * levels change. If it were given back to the system, its pages would be faulted in and zeroed again, which
 * takes as long as a frame. */
static void keep_freed_memory(void)
{
    mallopt(M_ARENA_MAX, 1); /* memory that the loader's thread frees is usable by all */
    const int largest_kept = 32 << 20, trimmed_beyond = 256 << 20; /* bytes; 32 MiB is what glibc allows */
    mallopt(M_MMAP_THRESHOLD, largest_kept);
    mallopt(M_TRIM_THRESHOLD, trimmed_beyond);
}

/* The environment that libraries read before main begins: the program sets it and executes itself again; where that fails it
 * only runs slower. Idle OpenMP threads would spin on the cores that software GL's threads need. Memory in
 * pages of 4 kB is faulted in one page at a time, which takes up to a quarter of the time of a small still.
 */
static void set_environment(char **argv)
{
    static const char *const variables[][2] = {{"OMP_WAIT_POLICY", "passive"},
                                               {"GLIBC_TUNABLES", "glibc.malloc.hugetlb=1"}};
    bool changes = false;
    for (size_t i = 0; i < TL_COUNT(variables); i++)
        if (!getenv(variables[i][0]) && setenv(variables[i][0], variables[i][1], 0) == 0)
            changes = true;
    if (changes)
        execv("/proc/self/exe", argv);
    prctl(PR_SET_NAME, "toile"); /* the kernel named it "exe" after the file that was executed */
}

/* Mesa's EGL would print lines of its own about what render/gpu reports in one. */
static void silence_egl(void)
{
    setenv("EGL_LOG_LEVEL", "fatal", 0);
}

/* Bytes at the end of `text` that begin a sequence of UTF-8 and do not end it. */
static size_t unfinished(const char *text, size_t length)
{
    for (size_t back = 1; back <= 3 && back <= length; back++) {
        unsigned char c = (unsigned char)text[length - back];
        if (c >= 0xc0)
            return (c >= 0xf0 ? 4u : c >= 0xe0 ? 3u : 2u) > back ? back : 0;
        if (c < 0x80)
            return 0;
    }
    return 0;
}

/* Results hold names from files. All of stdout passes through here, line by line, so that none of them
 * reaches a terminal as a command. What comes may end within a character, which is kept until the rest comes.
 */
static ssize_t write_clean(void *cookie, const char *bytes, size_t size)
{
    static char kept[4];
    (void)cookie;
    char *text = tl_format("%s%.*s", kept, (int)size, bytes);
    size_t length = strlen(text), rest = unfinished(text, length), written = 0;
    length -= rest;
    memcpy(kept, text + length, rest + 1);
    text[length] = '\0';
    for (char *line = text, *next; line; line = next) {
        next = strpbrk(line, "\n\t");
        char stop = next ? *next : '\0';
        if (next)
            *next++ = '\0';
        tl_clean_line(line);
        if (next)
            next[-1] = stop;
    }
    ssize_t count = 1;
    for (; written < length && count > 0; written += (size_t)(count > 0 ? count : 0))
        count = write(STDOUT_FILENO, text + written, length - written);
    free(text);
    return written == length ? (ssize_t)size : 0;
}

static void clean_stdout(void)
{
    FILE *stream = fopencookie(NULL, "w", (cookie_io_functions_t){.write = write_clean});
    if (!stream)
        return;
    setvbuf(stream, NULL, isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF, 1 << 16);
    stdout = stream;
}

int main(int argc, char **argv)
{
    set_environment(argv);
    silence_egl();
    keep_freed_memory();
    clean_stdout();
    setlocale(LC_ALL, "C"); /* numbers in files and results have a point, wherever the user lives */
    tl_interrupt_install();
    tl_error error = {0};
    bool done = run(argc, argv, &error);
    if (!done && error.message[0])
        fprintf(stderr, "toile: %s\n", error.message);
    /* A full disk or a closed pipe must not pass for success. */
    if ((fflush(stdout) != 0 || ferror(stdout)) && done) {
        fprintf(stderr, "toile: standard output: could not be written: free some space or check the pipe\n");
        return tl_exit_status(TL_OUTPUT);
    }
    return done ? 0 : tl_exit_status(error.code);
}
