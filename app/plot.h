/* Plots as inline SVG for the reports: points and lines over two axes, with a legend, points that tell their
 * name when hovered, and names beside those that deserve one. Colours come from the page's style sheet
 * (app/report.h), so that a plot suits a light and a dark page. Pure but for the stream. */
#ifndef TOILE_APP_PLOT_H
#define TOILE_APP_PLOT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#define TL_PLOT_STYLES 8 /* colours and marks; series beyond begin again */

struct tl_plot_point {
    double x, y; /* positive on logarithmic axes; points that are not finite are left out */
    const char *name;
    bool named; /* its name stands beside it; else it shows when hovered */
};

struct tl_plot_series {
    const char *name;
    const struct tl_plot_point *points;
    size_t count;
    bool line;  /* points are joined, in their order */
    bool front; /* a dashed line without marks: the Pareto front */
};

struct tl_plot {
    const char *x_label, *y_label;
    bool x_log, y_log;
    const struct tl_plot_series *series;
    size_t series_count;
};

/* The text with &, <, > and quotes as HTML and SVG want them. */
void tl_html_print(FILE *out, const char *text);

void tl_plot_print(FILE *out, const struct tl_plot *plot);

/* The best of `points` where less x and less y are both better: indices in order of rising x. Returns their
 * number; `best` holds up to `count`. */
size_t tl_pareto_front(const struct tl_plot_point *points, size_t count, size_t *best);

#endif
