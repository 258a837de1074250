/* The command that renders contact sheets. */
#ifndef TOILE_APP_SHEET_COMMANDS_H
#define TOILE_APP_SHEET_COMMANDS_H

#include "app/cli/arguments.h"

/* Renders a contact sheet, as a folder or as one image. Reports its failure through `error` and returns
 * false. */
bool tl_command_sheet(const struct tl_arguments *arguments, tl_error *error);

#endif
