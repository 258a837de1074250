/* A command of the program: its name, the flags that it takes, and the function that runs it. Each room
 * declares the functions of its own commands in its commands.h; app/commands.c holds the table of them all.
 *
 * Errors: `run` fails with one line. A command that ran and whose check failed returns false with code
 * TL_UNSTABLE and an empty message. Results go to stdout, messages to stderr. Threads: the main thread. */
#ifndef TOILE_APP_CLI_COMMAND_H
#define TOILE_APP_CLI_COMMAND_H

#include "app/cli/arguments.h"

struct tl_command {
    const char *name;
    const char *usage; /* "render [SCENE] -o OUT" */
    const char *help;  /* what it does, one line */
    unsigned flags;    /* enum tl_flag_set, combined */
    bool (*run)(const struct tl_arguments *arguments, tl_error *error);
};

#endif
