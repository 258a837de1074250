/* Commands of this room: files in, files out. app/cli/command.h says what a command is. */
#ifndef TOILE_APP_BATCH_COMMANDS_H
#define TOILE_APP_BATCH_COMMANDS_H

#include "app/cli/arguments.h"

bool tl_command_render(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_plan(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_compare(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_export(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_fabric(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_env(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_info(const struct tl_arguments *arguments, tl_error *error);

#endif
