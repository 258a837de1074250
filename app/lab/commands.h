/* The command of the lab that has no room of its own: the extremes are tests. app/cli/command.h says what a
 * command is. */
#ifndef TOILE_APP_LAB_COMMANDS_H
#define TOILE_APP_LAB_COMMANDS_H

#include "app/cli/arguments.h"

bool tl_command_stability(const struct tl_arguments *arguments, tl_error *error);

#endif
