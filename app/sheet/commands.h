/* Commands of this room: the contact sheet. app/cli/command.h says what a command is. */
#ifndef TOILE_APP_SHEET_COMMANDS_H
#define TOILE_APP_SHEET_COMMANDS_H

#include "app/cli/arguments.h"

bool tl_command_sheet(const struct tl_arguments *arguments, tl_error *error);

#endif
