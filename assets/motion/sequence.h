/* Sequences of files: one a frame, named by a pattern such as `sky.####.exr`, in which the run of # stands
 * for the frame's number, with zeros in front to as many digits. Ownership: the caller's. Threads: pure, but
 * for reading a folder. */
#ifndef TOILE_ASSETS_MOTION_SEQUENCE_H
#define TOILE_ASSETS_MOTION_SEQUENCE_H

#include "config/error.h"

#include <stddef.h>

/* True when the file name (not its folder) holds a #, and no file has that very name. */
bool tl_sequence_is_pattern(const char *name);

/* The numbers of the files that a pattern `text` stands for, rising; at least one; free(*numbers). */
bool tl_sequence_list(const char *text, int **numbers, size_t *count, tl_error *error);

/* The file of a number, for a text that tl_sequence_list took; new string. */
char *tl_sequence_path(const char *text, int number);

#endif
