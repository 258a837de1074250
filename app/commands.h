/* The table of commands: the only place that knows every one of them. */
#ifndef TOILE_APP_COMMANDS_H
#define TOILE_APP_COMMANDS_H

#include "app/cli/command.h"

/* The command of this name; NULL and TL_USAGE, with the nearest name, when there is none. Static. */
const struct tl_command *tl_command_find(const char *name, tl_error *error);

/* The command `help`, which lists the table. */
bool tl_command_help(const struct tl_arguments *arguments, tl_error *error);

#endif
