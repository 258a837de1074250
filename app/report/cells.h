/* Cells of a report's table, filled row by row, the heads first. */
#ifndef TOILE_APP_REPORT_CELLS_H
#define TOILE_APP_REPORT_CELLS_H

#include <stddef.h>
#include <stdio.h>

struct tl_cells {
    char **texts;
    size_t count;
};

void tl_cells_add(struct tl_cells *cells, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Prints the table and forgets it. */
void tl_cells_print(struct tl_cells *cells, size_t columns, FILE *out);

#endif
