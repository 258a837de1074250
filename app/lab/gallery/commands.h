/* Commands of this room: every technique compared with its exact evaluation. app/cli/command.h defines a
 * command. */
#ifndef TOILE_APP_LAB_GALLERY_COMMANDS_H
#define TOILE_APP_LAB_GALLERY_COMMANDS_H

#include "app/cli/arguments.h"

bool tl_command_gallery(const struct tl_arguments *arguments, tl_error *error);

#endif
