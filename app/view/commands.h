/* Commands of this room: the review window. app/cli/command.h defines a command. */
#ifndef TOILE_APP_VIEW_COMMANDS_H
#define TOILE_APP_VIEW_COMMANDS_H

#include "app/cli/arguments.h"

bool tl_command_view(const struct tl_arguments *arguments, tl_error *error);

#endif
