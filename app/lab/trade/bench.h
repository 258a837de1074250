/* The measurements of `toile bench`, one function a topic. Each prints a table, or one JSON object with
 * --json. */
#ifndef TOILE_APP_LAB_TRADE_BENCH_H
#define TOILE_APP_LAB_TRADE_BENCH_H

#include "app/cli/arguments.h"

bool tl_bench_light(const struct tl_arguments *arguments, tl_error *error);
bool tl_bench_shading(const struct tl_arguments *arguments, tl_error *error);

#endif
