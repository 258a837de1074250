/* Writes a report: one HTML page with text, tables, plots (app/report/plot.h) and pictures, without scripts,
 * in the reader's light or dark colours.
 *
 * Texts are UTF-8 and need no escaping; the page declares its encoding. The functions print in the order of
 * the calls, between tl_report_begin and tl_report_end. Errors: the caller opens the stream and finds write
 * errors when it commits it (tl_writer). Lifetime: nothing is kept. Threads: one stream at a time each. */
#ifndef TOILE_APP_REPORT_REPORT_H
#define TOILE_APP_REPORT_REPORT_H

#include "app/report/plot.h"

/* Begins the page with its title, a line below the title, and the style sheet. */
void tl_report_begin(FILE *out, const char *title, const char *subtitle);
void tl_report_end(FILE *out);

void tl_report_heading(FILE *out, const char *text);
void tl_report_paragraph(FILE *out, const char *text);

/* Prints cells[row * columns + column] as a table. The first row holds the heads of the columns, the first
 * column those of the rows. */
void tl_report_table(FILE *out, const char *const *cells, size_t rows, size_t columns);

/* Prints the report's main figures in large type, as many side by side as fit: cells[2 i] is a value, cells[2
 * i + 1] its name. */
void tl_report_tiles(FILE *out, const char *const *cells, size_t count);

/* Encloses a part of the page that is folded away until its title is clicked. */
void tl_report_fold_begin(FILE *out, const char *title);
void tl_report_fold_end(FILE *out);

/* Prints a plot and a caption below it; the first with default options. */
void tl_report_plot(FILE *out, const struct tl_plot *plot, const char *caption);
void tl_report_plot_with(FILE *out, const struct tl_plot *plot, const struct tl_plot_options *options,
                         const char *caption);

/* Encloses pictures, of which as many are side by side as fit. */
void tl_report_pictures_begin(FILE *out);
/* Prints a picture within the page: a PNG of `size` bytes. */
void tl_report_picture(FILE *out, const void *png, size_t size, const char *name, const char *caption);
/* Prints a picture by the name of its file, which lies in the page's folder. */
void tl_report_picture_file(FILE *out, const char *file, const char *name, const char *caption);
void tl_report_pictures_end(FILE *out);

/* Prints a picture as wide as the page, outside of tl_report_pictures_begin and end: a file in the page's
 * folder, loaded when the reader scrolls to it. A click opens it in full size. */
struct tl_report_file {
    const char *name;
    int width, height; /* pixels: the page keeps its place free */
};
void tl_report_wide_picture(FILE *out, const struct tl_report_file *file, const char *name,
                            const char *caption);

#endif
