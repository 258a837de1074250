/* Writes files into a report's folder, which must exist. A file appears whole or not at all (tl_writer).
 * Errors: false, with a message that names the path. Threads: any, each with files of its own. */
#ifndef TOILE_APP_REPORT_FOLDER_H
#define TOILE_APP_REPORT_FOLDER_H

#include "config/base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Writes FOLDER/NAME: `write` prints `what` to the stream it gets. */
bool tl_folder_print(const char *folder, const char *name, const void *what,
                     void (*write)(const void *what, FILE *out), tl_error *error);

/* Writes `size` bytes as FOLDER/NAME. */
bool tl_folder_put(const char *folder, const char *name, const void *bytes, size_t size, tl_error *error);

#endif
