#include "app/report/cells.h"

#include "app/report/report.h"
#include "config/memory.h"

#include <stdarg.h>
#include <stdlib.h>

void tl_cells_add(struct tl_cells *cells, const char *format, ...)
{
    char text[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    cells->texts = tl_resize(cells->texts, cells->count + 1, sizeof *cells->texts);
    cells->texts[cells->count++] = tl_copy_string(text);
}

void tl_cells_print(struct tl_cells *cells, size_t columns, FILE *out)
{
    tl_report_table(out, (const char *const *)cells->texts, cells->count / columns, columns);
    for (size_t i = 0; i < cells->count; i++)
        free(cells->texts[i]);
    free(cells->texts);
    *cells = (struct tl_cells){0};
}
