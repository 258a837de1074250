/* toile stability: executes toile-stability, which holds the extremes and is built with the tests
 * (tests/app/stability), in the place of this program. */
#include "app/lab/commands.h"
#include "config/base/memory.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* From the program's own folder: where the build leaves it, and where it is installed. */
static const char *const places[] = {"toile-stability", "../libexec/toile/toile-stability"};

bool tl_command_stability(const struct tl_arguments *arguments, tl_error *error)
{
    char folder[PATH_MAX] = "";
    if (readlink("/proc/self/exe", folder, sizeof folder - 1) < 0)
        return tl_fail(error, TL_INPUT, "/proc/self/exe: cannot be read: mount /proc");
    *strrchr(folder, '/') = '\0';
    for (size_t i = 0; i < TL_COUNT(places); i++) {
        char *program = tl_format("%s/%s", folder, places[i]);
        execv(program, arguments->command_line);
        free(program);
    }
    return tl_fail(error, TL_INPUT,
                   "%s/%s: cannot be executed: it is built with the tests: build all of toile, or install it",
                   folder, places[0]);
}
