/* Commands of this room: recorded fly-throughs. app/cli/command.h defines a command. */
#ifndef TOILE_APP_LAB_FLIGHT_COMMANDS_H
#define TOILE_APP_LAB_FLIGHT_COMMANDS_H

#include "app/cli/arguments.h"

bool tl_command_fly(const struct tl_arguments *arguments, tl_error *error);

#endif
