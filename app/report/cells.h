/* The texts of a report's table, added row by row: first the heads of the columns, then the rows. Errors:
 * none. Threads: one at a time. */
#ifndef TOILE_APP_REPORT_CELLS_H
#define TOILE_APP_REPORT_CELLS_H

#include <stddef.h>
#include <stdio.h>

/* Starts as {0}. Owns its texts until tl_cells_print. */
struct tl_cells {
    char **texts;
    size_t count;
};

/* Adds the next cell, as printf formats it; of any length. */
void tl_cells_add(struct tl_cells *cells, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints the cells as a table of `columns` columns (tl_report_table), frees them and leaves {0}. */
void tl_cells_print(struct tl_cells *cells, size_t columns, FILE *out);

#endif
