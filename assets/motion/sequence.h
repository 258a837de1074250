/* Sequences of files, one per frame, named by a pattern such as `sky.####.exr`, in which the run of # stands
 * for the frame's number, padded with zeros to as many digits. Lifetime: results are the caller's. Threads:
 * any. */
#ifndef TOILE_ASSETS_MOTION_SEQUENCE_H
#define TOILE_ASSETS_MOTION_SEQUENCE_H

#include "config/base/error.h"

#include <stddef.h>

/* Whether the file name (not its folder) holds a #, and no file of that very name exists. */
bool tl_sequence_is_pattern(const char *name);

/* Lists the numbers of the files that match the pattern `text`, rising; at least one; free(*numbers). */
bool tl_sequence_list(const char *text, int **numbers, size_t *count, tl_error *error);

/* The path of the file of a number, for a pattern that tl_sequence_list accepted; new string. */
char *tl_sequence_path(const char *text, int number);

#endif
