/* The command of fabrics: lists what a fabric's file holds and what becomes of it, writes it in toile's own
 * form, and bakes maps from height maps (app/cli/command.h). */
#ifndef TOILE_APP_FABRIC_COMMANDS_H
#define TOILE_APP_FABRIC_COMMANDS_H

#include "app/cli/arguments.h"

bool tl_command_fabric(const struct tl_arguments *arguments, tl_error *error);

#endif
