/* Commands of this room: error against time, and ratios of speed. app/cli/command.h defines a command.
 */
#ifndef TOILE_APP_LAB_TRADE_COMMANDS_H
#define TOILE_APP_LAB_TRADE_COMMANDS_H

#include "app/cli/arguments.h"

bool tl_command_trade(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_bench(const struct tl_arguments *arguments, tl_error *error);

#endif
