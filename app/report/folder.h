/* Files of a report's folder. */
#ifndef TOILE_APP_REPORT_FOLDER_H
#define TOILE_APP_REPORT_FOLDER_H

#include "config/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* FOLDER/NAME as `write` prints `what`, or as `size` bytes; atomic. */
bool tl_folder_print(const char *folder, const char *name, const void *what,
                     void (*write)(const void *what, FILE *out), tl_error *error);
bool tl_folder_put(const char *folder, const char *name, const void *bytes, size_t size, tl_error *error);

#endif
