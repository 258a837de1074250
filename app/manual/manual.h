/* The man pages and the completion of command lines, made from the same tables as --help: commands, flags,
 * options.
 *
 * Errors: none; the caller checks `out` (ferror). Lifetime: keeps nothing. Threads: one at a time for `out`.
 */
#ifndef TOILE_APP_MANUAL_MANUAL_H
#define TOILE_APP_MANUAL_MANUAL_H

#include "app/cli/command.h"
#include "config/options.h"

#include <stddef.h>
#include <stdio.h>

struct tl_manual { /* borrowed */
    const char *version;
    const struct tl_command *commands;
    size_t command_count;
    const struct tl_binding *bindings; /* every option; their values are the defaults */
    size_t binding_count;
};

/* toile.1 in troff's man macros: commands, every option, exit status, files. */
void tl_manual_print(const struct tl_manual *manual, FILE *out);
/* toile-COMMAND.1. */
void tl_manual_print_command(const struct tl_manual *manual, const struct tl_command *command, FILE *out);

/* Prints what can stand at the end of `line`, a command line from the program's name to the cursor: one
 * candidate a line, a tab, and its help. The first line is "+files" where a file's name may stand too. Words
 * are split at blanks; quotes mean nothing. */
void tl_complete_print(const struct tl_manual *manual, const char *line, FILE *out);

#endif
