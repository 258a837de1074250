/* What an earlier, clean run of the same scene found: a file that `toile check --json` has printed. With it
 * the bounds of a run are those of its own scene. Pure; threads: any. */
#ifndef TOILE_APP_LAB_CHECK_BASELINE_H
#define TOILE_APP_LAB_CHECK_BASELINE_H

#include "app/lab/check/check_run.h"

/* A hash of all that a run depends on. */
uint64_t tl_baseline_scene(const struct tl_settings *settings, const struct tl_check_params *params);

/* Errors: TL_INPUT for a file that is no such result, or one of another scene. */
bool tl_baseline_load(const char *file, uint64_t scene, struct tl_check_baseline *out, tl_error *error);

#endif
