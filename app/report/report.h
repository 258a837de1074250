/* Reports: one page (app/report/page/) that shows the JSON which is written into it. A report's script,
 * beside the C file that writes its data, builds the page from page.js and plot.js. The page needs no other
 * file, except pictures that the data names. Measured curves and tables that no file of figures holds are
 * figures of the data.
 *
 * Texts are UTF-8 and need no escaping. Errors: as of app/report/folder.h. Threads: any, each with data of
 * its own. */
#ifndef TOILE_APP_REPORT_REPORT_H
#define TOILE_APP_REPORT_REPORT_H

#include "config/base/error.h"

#include <cjson/cJSON.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Writes FOLDER/FILE: the page with `data`, which it deletes, and the report's script: the text of a file
 * that the room of the report embeds (toile_embed). */
bool tl_report_write(const char *folder, const char *file, const char *script, cJSON *data, tl_error *error);

/* Adds the text that `write` prints of `what`, as a string: the content of a CSV file. */
void tl_report_add_text(cJSON *object, const char *key, const void *what,
                        void (*write)(const void *what, FILE *out));

/* Adds an array of texts, empty where there are none. */
void tl_report_add_texts(cJSON *object, const char *key, char *const *texts, size_t count);

/* New string of JSON: a PNG of `size` bytes as the address of a picture ("data:image/png;base64,..."). */
cJSON *tl_report_png(const void *png, size_t size);

/* ---- Figures: appended to an array of the data ---- */

struct tl_report_plot {
    const char *x_label, *y_label;
    bool x_log, y_log;
    const char *caption;
};
/* Returns the plot's series, an array of the data. */
cJSON *tl_report_add_plot(cJSON *figures, const struct tl_report_plot *plot);
/* Adds a series whose points are joined; with `is_front` by a dashed line without marks. Returns its points.
 */
cJSON *tl_report_add_series(cJSON *series, const char *name, bool is_front);
/* Adds a point. A value that is not finite becomes null, and the point is not drawn. */
void tl_report_add_point(cJSON *points, double x, double y);

struct tl_report_column {
    const char *head;
    int digits; /* behind the decimal point */
};
/* Adds a table of `count` columns; returns its rows. */
cJSON *tl_report_add_table(cJSON *figures, const struct tl_report_column *columns, int count);
/* Adds a row: its name, and the values of the other columns. */
void tl_report_add_row(cJSON *rows, const char *name, const double *values, int count);

#endif
