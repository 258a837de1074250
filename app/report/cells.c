#include "app/report/cells.h"

#include "app/report/report.h"
#include "config/memory.h"

#include <stdarg.h>
#include <stdlib.h>

void tl_cells_add(struct tl_cells *cells, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    size_t size = (size_t)vsnprintf(NULL, 0, format, arguments) + 1;
    char *text = tl_alloc(size, 1);
    vsnprintf(text, size, format, again);
    va_end(again);
    va_end(arguments);
    cells->texts = tl_resize(cells->texts, cells->count + 1, sizeof *cells->texts);
    cells->texts[cells->count++] = text;
}

void tl_cells_print(struct tl_cells *cells, size_t columns, FILE *out)
{
    tl_report_table(out, (const char *const *)cells->texts, cells->count / columns, columns);
    for (size_t i = 0; i < cells->count; i++)
        free(cells->texts[i]);
    free(cells->texts);
    *cells = (struct tl_cells){0};
}
