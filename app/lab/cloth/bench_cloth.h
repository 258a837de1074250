/* `toile bench cloth`: the solvers against each other and against a plain loop. Prints a table, or one JSON
 * object with --json. Errors: those of the drapes that it makes. Threads: the caller's; OpenMP inside. */
#ifndef TOILE_APP_LAB_CLOTH_BENCH_CLOTH_H
#define TOILE_APP_LAB_CLOTH_BENCH_CLOTH_H

#include "app/cli/arguments.h"

bool tl_bench_cloth(const struct tl_arguments *arguments, tl_error *error);

#endif
