/* Reports: one self-contained HTML file for people, with plots (app/report/plot.h), tables and pictures
 * inside it; no script, light and dark as the reader's screen is. The caller opens and commits the stream
 * (tl_writer). Pure but for the stream. */
#ifndef TOILE_APP_REPORT_REPORT_H
#define TOILE_APP_REPORT_REPORT_H

#include "app/report/plot.h"

void tl_report_begin(FILE *out, const char *title, const char *subtitle);
void tl_report_end(FILE *out);

void tl_report_heading(FILE *out, const char *text);
void tl_report_paragraph(FILE *out, const char *text);

/* cells[row][column]; the first row is the heads, the first column names what the row is about. */
void tl_report_table(FILE *out, const char *const *cells, size_t rows, size_t columns);

/* Figures to see at once, as many side by side as fit: cells[i] = value, then what it is. */
void tl_report_tiles(FILE *out, const char *const *cells, size_t count);

/* What few want to read stays folded until asked for. */
void tl_report_fold_begin(FILE *out, const char *title);
void tl_report_fold_end(FILE *out);

/* A plot with a caption below it. */
void tl_report_plot(FILE *out, const struct tl_plot *plot, const char *caption);
void tl_report_plot_as(FILE *out, const struct tl_plot *plot, const struct tl_plot_manner *manner,
                       const char *caption);

/* Pictures side by side, as many as fit. */
void tl_report_pictures_begin(FILE *out);
void tl_report_picture(FILE *out, const void *png, size_t size, const char *name, const char *caption);
/* The same of a file beside the report, which then holds only its name. */
void tl_report_picture_beside(FILE *out, const char *file, const char *name, const char *caption);
void tl_report_pictures_end(FILE *out);

#endif
