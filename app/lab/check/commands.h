/* Commands of this room: invariants, frame by frame. app/cli/command.h defines a command. */
#ifndef TOILE_APP_LAB_CHECK_COMMANDS_H
#define TOILE_APP_LAB_CHECK_COMMANDS_H

#include "app/cli/arguments.h"

bool tl_command_check(const struct tl_arguments *arguments, tl_error *error);

#endif
