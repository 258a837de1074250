/* Commands of this room: extreme inputs. app/cli/command.h defines a command. */
#ifndef TOILE_APP_LAB_STABILITY_COMMANDS_H
#define TOILE_APP_LAB_STABILITY_COMMANDS_H

#include "app/cli/arguments.h"

bool tl_command_stability(const struct tl_arguments *arguments, tl_error *error);

#endif
