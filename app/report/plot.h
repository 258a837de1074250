/* Plots as inline SVG for the reports: points and lines over two axes, with a legend, points that tell their
 * name when hovered, and names beside those that deserve one. Colours come from the page's style sheet
 * (app/report/report.h), so that a plot suits a light and a dark page. Pure but for the stream. */
#ifndef TOILE_APP_REPORT_PLOT_H
#define TOILE_APP_REPORT_PLOT_H

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
#define TL_PLOT_WIDTH 760.0

/* How series are drawn. */
enum tl_plot_kind {
    TL_PLOT_LINES,
    TL_PLOT_STEPS, /* lines whose values hold until the next point */
    TL_PLOT_AREAS, /* filled down to 0, later series behind earlier ones */
    TL_PLOT_BARS   /* on 0, of equal width in x */
};

/* A level that is told, across the whole plot. */
struct tl_plot_guide {
    double y;
    const char *name;
};

/* What a plot may have beside its points; all 0 is a plain plot. */
struct tl_plot_manner {
    enum tl_plot_kind kind;
    double bar_width;
    const struct tl_plot_guide *guides; /* in view whatever the points are */
    size_t guide_count;
    double shaded_to; /* x from 0 to here is set apart; 0: nothing is */
    double height;    /* of the drawing, whose width is TL_PLOT_WIDTH; 0: its own */
    bool x_tight;     /* no margin behind the largest x */
    bool y_whole;     /* y counts: ticks at whole numbers only */
    bool y_bare;      /* y is a matter of drawing: no ticks, guides are plain lines without names */
};

/* The text with &, <, > and quotes as HTML and SVG want them. */
void tl_html_print(FILE *out, const char *text);

void tl_plot_print_as(FILE *out, const struct tl_plot *plot, const struct tl_plot_manner *manner);

/* The best of `points` where less x and less y are both better: indices in order of rising x. Returns their
 * number; `best` holds up to `count`. */
size_t tl_pareto_front(const struct tl_plot_point *points, size_t count, size_t *best);

#endif
