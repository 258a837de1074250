/* Prints plots as inline SVG: points and lines over two axes with a legend. A point shows its name when the
 * mouse is over it, and beside it where that is asked for and there is room. The page's style sheet sets the
 * colours (app/report/report.h), so that a plot suits a light and a dark page.
 *
 * Texts are UTF-8 and need no escaping. Errors: the caller finds write errors when it commits the stream.
 * Lifetime: nothing is kept. Threads: any, each with a stream of its own. */
#ifndef TOILE_APP_REPORT_PLOT_H
#define TOILE_APP_REPORT_PLOT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#define TL_PLOT_STYLES 8     /* pairs of colour and mark; the ninth series has the first again */
#define TL_PLOT_WIDTH  760.0 /* units of the drawing's view box */

struct tl_plot_point {
    double x, y; /* positive on logarithmic axes; other points and those that are not finite are left out */
    const char *name;
    bool named; /* the name is printed beside the point, where it covers nothing */
};

struct tl_plot_series {
    const char *name;
    const struct tl_plot_point *points;
    size_t count;
    bool line;  /* joins the points in their order */
    bool front; /* a dashed line without marks: the Pareto front */
};

struct tl_plot {
    const char *x_label, *y_label;
    bool x_log, y_log;
    const struct tl_plot_series *series;
    size_t series_count;
};

enum tl_plot_kind {
    TL_PLOT_LINES,
    TL_PLOT_STEPS, /* each value holds until the next point */
    TL_PLOT_AREAS, /* filled down to 0, later series behind earlier ones */
    TL_PLOT_BARS   /* from 0 up, of equal width in x */
};

/* A level marked by a line across the whole plot. */
struct tl_plot_guide {
    double y;
    const char *name;
};

/* Style of a plot; {0} is a plot of lines with the default height. */
struct tl_plot_options {
    enum tl_plot_kind kind;
    double bar_width;                   /* in x; for bars */
    const struct tl_plot_guide *guides; /* the y axis reaches all of them */
    size_t guide_count;
    double shaded_to;  /* the ground from x = 0 to here is shaded; 0: nowhere */
    double height;     /* of the view box, TL_PLOT_WIDTH wide; 0: the default */
    bool x_tight;      /* no margin behind the largest x */
    bool y_is_count;   /* ticks at whole numbers only */
    bool y_unlabelled; /* no ticks in y, and guides without names */
};

/* Prints the text with &, <, > and double quotes escaped, for elements and attributes of HTML and SVG. */
void tl_html_print(FILE *out, const char *text);

/* Prints the plot and its legend. */
void tl_plot_print(FILE *out, const struct tl_plot *plot, const struct tl_plot_options *options);

/* Finds the Pareto front of points whose x and y are both better when smaller: the points for which no other
 * has a smaller y at a smaller or equal x. Writes their indices into `best`, which holds `count`, in order of
 * rising x; returns their number. Points that are not finite are left out. */
size_t tl_pareto_front(const struct tl_plot_point *points, size_t count, size_t *best);

#endif
