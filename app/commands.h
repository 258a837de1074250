/* The commands of the program. Each takes its parsed arguments and fails with one line; a command whose check
 * failed without an error sets code TL_UNSTABLE. Results go to stdout, all else to stderr. */
#ifndef TOILE_APP_COMMANDS_H
#define TOILE_APP_COMMANDS_H

#include "app/cli/arguments.h"

struct tl_command {
    const char *name;
    const char *usage; /* "render [SCENE] -o OUT" */
    const char *help;  /* what it does, one line */
    unsigned flags;    /* tl_flag_set */
    bool (*run)(const struct tl_arguments *arguments, tl_error *error);
};

/* NULL when there is none of this name. */
const struct tl_command *tl_command_find(const char *name, tl_error *error);

bool tl_command_view(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_render(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_plan(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_bench(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_check(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_trade(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_stability(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_fly(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_gallery(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_sheet(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_compare(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_export(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_fabric(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_env(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_info(const struct tl_arguments *arguments, tl_error *error);
bool tl_command_help(const struct tl_arguments *arguments, tl_error *error);

#endif
