#include "app/report/plot.h"

#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the drawing, in its own units. */
#define WIDTH  TL_PLOT_WIDTH
#define HEIGHT 430.0
#define LEFT   66.0
#define RIGHT  20.0
#define TOP    14.0
#define BOTTOM 52.0

#define LETTER_WIDTH  6.3 /* of the names, on average */
#define LETTER_HEIGHT 13.0
#define TICKS_MAX     32
#define CURVE_POINTS  40 /* a line of more is a curve, whose points have no marks */

struct axis {
    double low, high; /* values at its ends */
    bool logarithmic;
    double from, to; /* where they are drawn */
};

struct box {
    double x0, y0, x1, y1;
};

struct canvas {
    FILE *out;
    const struct tl_plot_manner *manner;
    double height;
    struct axis x, y;
    struct box *taken; /* by marks and names */
    size_t taken_count;
};

void tl_html_print(FILE *out, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        default:
            fputc(*text, out);
        }
}

static double place(const struct axis *axis, double value)
{
    double share = axis->logarithmic ? log(value / axis->low) / log(axis->high / axis->low)
                                     : (value - axis->low) / (axis->high - axis->low);
    return axis->from + share * (axis->to - axis->from);
}

static bool usable(const struct tl_plot *plot, const struct tl_plot_point *point)
{
    return isfinite(point->x) && isfinite(point->y) && (!plot->x_log || point->x > 0) &&
           (!plot->y_log || point->y > 0);
}

/* Room for all values and a margin around them; a linear axis begins at 0. */
static struct axis make_axis(double low, double high, bool logarithmic, bool tight, double from, double to)
{
    const double margin_share = tight ? 0 : 0.07;
    struct axis axis = {low, high, logarithmic, from, to};
    if (low > high) { /* no value at all */
        axis.low = 1;
        axis.high = 10;
    } else if (logarithmic) {
        double margin = high > low ? fmax(pow(high / low, margin_share), 1.05) : 2;
        axis.low = low / margin;
        axis.high = high * margin;
    } else {
        axis.low = fmin(low, 0);
        axis.high = high > axis.low ? high + margin_share * (high - axis.low) : axis.low + 1;
    }
    return axis;
}

static void find_axes(struct canvas *canvas, const struct tl_plot *plot)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t s = 0; s < plot->series_count; s++)
        for (size_t i = 0; i < plot->series[s].count; i++) {
            const struct tl_plot_point *point = &plot->series[s].points[i];
            if (!usable(plot, point))
                continue;
            low[0] = fmin(low[0], point->x);
            high[0] = fmax(high[0], point->x);
            low[1] = fmin(low[1], point->y);
            high[1] = fmax(high[1], point->y);
        }
    for (size_t i = 0; i < canvas->manner->guide_count; i++) {
        low[1] = fmin(low[1], canvas->manner->guides[i].y);
        high[1] = fmax(high[1], canvas->manner->guides[i].y);
    }
    canvas->x = make_axis(low[0], high[0], plot->x_log, canvas->manner->x_tight, LEFT, WIDTH - RIGHT);
    canvas->y = make_axis(low[1], high[1], plot->y_log, false, canvas->height - BOTTOM, TOP);
}

struct tick {
    double value;
    bool labelled;
};

/* 1, 2 and 5 of every decade; labels on all of them when there are few decades, else on the ones. */
static size_t log_ticks(const struct axis *axis, struct tick ticks[TICKS_MAX])
{
    static const double steps[] = {1, 2, 5};
    bool all = log10(axis->high / axis->low) < 2.6;
    size_t count = 0;
    int first = (int)floor(log10(axis->low)), last = (int)floor(log10(axis->high));
    for (int decade = first; decade <= last; decade++)
        for (size_t i = 0; i < TL_COUNT(steps); i++) {
            double value = pow(10, decade) * steps[i];
            if (value >= axis->low && value <= axis->high && count < TICKS_MAX)
                ticks[count++] = (struct tick){value, all || i == 0};
        }
    return count;
}

/* As many as have room. */
static size_t linear_ticks(const struct axis *axis, bool whole, struct tick ticks[TICKS_MAX])
{
    static const double factors[] = {1, 2, 5, 10};
    const double room = 40;
    double most = fmin(fmax(floor(fabs(axis->to - axis->from) / room), 2), 8);
    double decade = pow(10, floor(log10((axis->high - axis->low) / most))), step = decade;
    for (size_t i = 0; i < TL_COUNT(factors) && (axis->high - axis->low) / step > most; i++)
        step = factors[i] * decade;
    if (whole)
        step = fmax(step, 1);
    size_t count = 0;
    double first = ceil(axis->low / step);
    while (count < TICKS_MAX && (first + (double)count) * step <= axis->high) {
        ticks[count] = (struct tick){(first + (double)count) * step, true};
        count++;
    }
    return count;
}

static size_t find_ticks(const struct axis *axis, bool whole, struct tick ticks[TICKS_MAX])
{
    size_t count = axis->logarithmic ? log_ticks(axis, ticks) : 0;
    return count < 3 ? linear_ticks(axis, whole, ticks)
                     : count; /* a narrow range holds none of the round numbers */
}

static void print_y_ticks(const struct canvas *canvas)
{
    struct tick ticks[TICKS_MAX];
    size_t count = find_ticks(&canvas->y, canvas->manner->y_whole, ticks);
    for (size_t i = 0; i < count; i++) {
        double at = place(&canvas->y, ticks[i].value);
        fprintf(canvas->out, "<line class=\"grid\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n", LEFT,
                at, WIDTH - RIGHT, at);
        if (ticks[i].labelled)
            fprintf(canvas->out,
                    "<text class=\"tick\" text-anchor=\"end\" x=\"%.1f\" y=\"%.1f\">%.4g</text>\n", LEFT - 7,
                    at + 4, ticks[i].value);
    }
}

static void print_axes(const struct canvas *canvas, const struct tl_plot *plot)
{
    struct tick ticks[TICKS_MAX];
    FILE *out = canvas->out;
    size_t count = find_ticks(&canvas->x, false, ticks);
    for (size_t i = 0; i < count; i++) {
        double at = place(&canvas->x, ticks[i].value);
        fprintf(out, "<line class=\"grid\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n", at, TOP, at,
                canvas->height - BOTTOM);
        if (ticks[i].labelled)
            fprintf(out, "<text class=\"tick\" text-anchor=\"middle\" x=\"%.1f\" y=\"%.1f\">%.4g</text>\n",
                    at, canvas->height - BOTTOM + 16, ticks[i].value);
    }
    if (!canvas->manner->y_bare)
        print_y_ticks(canvas);
    fprintf(out, "<path class=\"frame\" d=\"M%.1f %.1fV%.1fH%.1f\"/>\n", LEFT, TOP, canvas->height - BOTTOM,
            WIDTH - RIGHT);
    fprintf(out, "<text class=\"axis\" text-anchor=\"middle\" x=\"%.1f\" y=\"%.1f\">",
            0.5 * (LEFT + WIDTH - RIGHT), canvas->height - 10);
    tl_html_print(out, plot->x_label);
    fprintf(
        out,
        "</text>\n<text class=\"axis\" text-anchor=\"middle\" transform=\"translate(15 %.1f) rotate(-90)\">",
        0.5 * (TOP + canvas->height - BOTTOM));
    tl_html_print(out, plot->y_label);
    fputs("</text>\n", out);
}

/* Marks of about equal weight, centred at 0: disc, square, diamond, triangles, cross, ring, bar. */
static const char *const marks[TL_PLOT_STYLES] = {
    "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z",
    "M-4 -4H4V4H-4z",
    "M0 -5.5L5.5 0L0 5.5L-5.5 0z",
    "M0 -5.5L5 3.5H-5z",
    "M0 5.5L5 -3.5H-5z",
    "M-1.6 -5H1.6V-1.6H5V1.6H1.6V5H-1.6V1.6H-5V-1.6H-1.6z",
    "M-5.5 -2.5H5.5V2.5H-5.5z",
    "M-2.5 -5.5H2.5V5.5H-2.5z",
};

static void take(struct canvas *canvas, struct box box)
{
    canvas->taken[canvas->taken_count++] = box;
}

/* Along the points, and back along 0 where the area below them is filled. */
static void print_line(const struct canvas *canvas, const struct tl_plot *plot,
                       const struct tl_plot_series *series, size_t style)
{
    bool steps = canvas->manner->kind == TL_PLOT_STEPS, areas = canvas->manner->kind == TL_PLOT_AREAS;
    bool begun = false;
    double first = 0, last = 0;
    for (size_t i = 0; i < series->count; i++) {
        const struct tl_plot_point *point = &series->points[i];
        if (!usable(plot, point))
            continue;
        if (!begun && series->front)
            fputs("<path class=\"front\" d=\"M", canvas->out);
        else if (!begun)
            fprintf(canvas->out, "<path class=\"%s s%zu\" d=\"M", areas ? "area" : "line", style);
        else if (!steps)
            fputc('L', canvas->out);
        double x = place(&canvas->x, point->x), y = place(&canvas->y, point->y);
        if (begun && steps)
            fprintf(canvas->out, "H%.1fV%.1f", x, y);
        else
            fprintf(canvas->out, "%.1f %.1f", x, y);
        first = begun ? first : x;
        last = x;
        begun = true;
    }
    if (begun && areas)
        fprintf(canvas->out, "L%.1f %.1fH%.1fZ", last, place(&canvas->y, canvas->y.low), first);
    if (begun)
        fputs("\"/>\n", canvas->out);
}

static void print_bars(const struct canvas *canvas, const struct tl_plot *plot,
                       const struct tl_plot_series *series, size_t style)
{
    double floor_y = place(&canvas->y, canvas->y.low);
    for (size_t i = 0; i < series->count; i++) {
        const struct tl_plot_point *point = &series->points[i];
        if (!usable(plot, point))
            continue;
        double from = place(&canvas->x, point->x - 0.5 * canvas->manner->bar_width),
               to = place(&canvas->x, point->x + 0.5 * canvas->manner->bar_width),
               top = place(&canvas->y, point->y);
        fprintf(canvas->out,
                "<rect class=\"mark s%zu\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"><title>",
                style, from, top, to - from, floor_y - top);
        tl_html_print(canvas->out, point->name);
        fputs("</title></rect>\n", canvas->out);
    }
}

static void print_shade(const struct canvas *canvas)
{
    if (canvas->manner->shaded_to > canvas->x.low)
        fprintf(canvas->out, "<rect class=\"shade\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"/>\n",
                LEFT, TOP, place(&canvas->x, fmin(canvas->manner->shaded_to, canvas->x.high)) - LEFT,
                canvas->height - BOTTOM - TOP);
}

static void print_guides(const struct canvas *canvas)
{
    const struct tl_plot_manner *manner = canvas->manner;
    for (size_t i = 0; i < manner->guide_count; i++) {
        double y = place(&canvas->y, manner->guides[i].y);
        fprintf(canvas->out, "<path class=\"%s\" d=\"M%.1f %.1fH%.1f\"/>\n",
                manner->y_bare ? "grid" : "guide", LEFT, y, WIDTH - RIGHT);
        if (manner->y_bare)
            continue;
        fprintf(canvas->out, "<text class=\"name\" text-anchor=\"end\" x=\"%.1f\" y=\"%.1f\">",
                WIDTH - RIGHT - 4, y - 5);
        tl_html_print(canvas->out, manner->guides[i].name);
        fputs("</text>\n", canvas->out);
    }
}

static void print_marks(struct canvas *canvas, const struct tl_plot *plot,
                        const struct tl_plot_series *series, size_t style)
{
    for (size_t i = 0; i < series->count; i++) {
        const struct tl_plot_point *point = &series->points[i];
        if (!usable(plot, point))
            continue;
        double x = place(&canvas->x, point->x), y = place(&canvas->y, point->y);
        take(canvas, (struct box){x - 4, y - 4, x + 4, y + 4});
        fprintf(canvas->out, "<path class=\"mark s%zu\" transform=\"translate(%.1f %.1f)\" d=\"%s\"><title>",
                style, x, y, marks[style]);
        tl_html_print(canvas->out, point->name);
        fprintf(canvas->out, " (%.4g, %.4g)</title></path>\n", point->x, point->y);
    }
}

static bool overlaps(const struct canvas *canvas, struct box box)
{
    if (box.x0 < LEFT || box.x1 > WIDTH || box.y0 < 0 || box.y1 > canvas->height - BOTTOM)
        return true;
    for (size_t i = 0; i < canvas->taken_count; i++) {
        const struct box *other = &canvas->taken[i];
        if (box.x0 < other->x1 && box.x1 > other->x0 && box.y0 < other->y1 && box.y1 > other->y0)
            return true;
    }
    return false;
}

/* Right, left, above, below, and the corners: the first place where the name covers nothing; where there is
 * none, hovering must do. */
static void print_name(struct canvas *canvas, const struct tl_plot_point *point)
{
    static const double ways[][2] = {{1, 0}, {-1, 0}, {0, -1}, {0, 1}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}};
    const double gap = 7;
    double x = place(&canvas->x, point->x), y = place(&canvas->y, point->y);
    double width = LETTER_WIDTH * (double)strlen(point->name), height = LETTER_HEIGHT;
    for (size_t i = 0; i < TL_COUNT(ways); i++) {
        double left = ways[i][0] > 0 ? x + gap : ways[i][0] < 0 ? x - gap - width : x - 0.5 * width;
        double middle = y + ways[i][1] * (gap + 0.5 * height);
        struct box box = {left, middle - 0.5 * height, left + width, middle + 0.5 * height};
        if (overlaps(canvas, box))
            continue;
        take(canvas, box);
        fprintf(canvas->out, "<text class=\"name\" x=\"%.1f\" y=\"%.1f\">", left, middle + 4);
        tl_html_print(canvas->out, point->name);
        fputs("</text>\n", canvas->out);
        return;
    }
}

static void print_names(struct canvas *canvas, const struct tl_plot *plot)
{
    for (size_t s = 0; s < plot->series_count; s++)
        for (size_t i = 0; !plot->series[s].front && i < plot->series[s].count; i++) {
            const struct tl_plot_point *point = &plot->series[s].points[i];
            if (point->named && usable(plot, point))
                print_name(canvas, point);
        }
}

static void print_legend(FILE *out, const struct tl_plot *plot)
{
    fputs("<ul class=\"legend\">", out);
    for (size_t s = 0; s < plot->series_count; s++) {
        const struct tl_plot_series *series = &plot->series[s];
        size_t style = s % TL_PLOT_STYLES;
        fputs("<li><svg viewBox=\"-9 -7 18 14\" width=\"18\" height=\"14\" aria-hidden=\"true\">", out);
        if (series->front)
            fputs("<path class=\"front\" d=\"M-8 0H8\"/>", out);
        else
            fprintf(out, "<path class=\"mark s%zu\" d=\"%s\"/>", style, marks[style]);
        fputs("</svg> ", out);
        tl_html_print(out, series->name);
        fputs("</li>", out);
    }
    fputs("</ul>\n", out);
}

static bool is_joined(const struct tl_plot_series *series, enum tl_plot_kind kind)
{
    return series->front || (series->line && kind != TL_PLOT_AREAS && kind != TL_PLOT_BARS);
}

static bool has_marks(const struct tl_plot_series *series, enum tl_plot_kind kind)
{
    bool curve = series->line && series->count > CURVE_POINTS;
    return !series->front && !curve && (kind == TL_PLOT_LINES || kind == TL_PLOT_STEPS);
}

/* Areas lie below the grid, all else above it. */
static void print_series(struct canvas *canvas, const struct tl_plot *plot)
{
    enum tl_plot_kind kind = canvas->manner->kind;
    for (size_t s = plot->series_count; s-- > 0 && kind == TL_PLOT_AREAS;)
        print_line(canvas, plot, &plot->series[s], s % TL_PLOT_STYLES);
    print_axes(canvas, plot);
    for (size_t s = 0; s < plot->series_count; s++) {
        if (kind == TL_PLOT_BARS)
            print_bars(canvas, plot, &plot->series[s], s % TL_PLOT_STYLES);
        if (is_joined(&plot->series[s], kind))
            print_line(canvas, plot, &plot->series[s], s % TL_PLOT_STYLES);
    }
    for (size_t s = 0; s < plot->series_count; s++)
        if (has_marks(&plot->series[s], kind))
            print_marks(canvas, plot, &plot->series[s], s % TL_PLOT_STYLES);
}

void tl_plot_print_as(FILE *out, const struct tl_plot *plot, const struct tl_plot_manner *manner)
{
    size_t points = 0;
    for (size_t s = 0; s < plot->series_count; s++)
        points += plot->series[s].count;
    struct canvas canvas = {.out = out,
                            .manner = manner,
                            .height = manner->height > 0 ? manner->height : HEIGHT,
                            .taken = TL_NEW_ARRAY(struct box, 2 * points)};
    find_axes(&canvas, plot);
    if (plot->series_count > 1 || manner->kind == TL_PLOT_LINES)
        print_legend(out, plot);
    fprintf(out, "<svg class=\"plot\" viewBox=\"0 0 %.0f %.0f\" role=\"img\">\n", WIDTH, canvas.height);
    print_shade(&canvas);
    print_series(&canvas, plot);
    print_guides(&canvas);
    print_names(&canvas, plot);
    fputs("</svg>\n", out);
    free(canvas.taken);
}

struct ranked {
    size_t index;
    double x, y;
};

static int compare_ranked(const void *a, const void *b)
{
    const struct ranked *first = a, *second = b;
    if (first->x != second->x)
        return first->x < second->x ? -1 : 1;
    return (first->y > second->y) - (first->y < second->y);
}

size_t tl_pareto_front(const struct tl_plot_point *points, size_t count, size_t *best)
{
    struct ranked *ranked = TL_NEW_ARRAY(struct ranked, count);
    size_t usable_count = 0, front = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(points[i].x) && isfinite(points[i].y))
            ranked[usable_count++] = (struct ranked){i, points[i].x, points[i].y};
    qsort(ranked, usable_count, sizeof *ranked, compare_ranked);
    double lowest = INFINITY;
    for (size_t i = 0; i < usable_count; i++)
        if (ranked[i].y < lowest) {
            lowest = ranked[i].y;
            best[front++] = ranked[i].index;
        }
    free(ranked);
    return front;
}
