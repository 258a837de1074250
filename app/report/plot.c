#include "app/report/plot.h"

#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sizes in the units of the drawing's view box. */
#define WIDTH  TL_PLOT_WIDTH
#define HEIGHT 430.0
#define LEFT   66.0
#define RIGHT  20.0
#define TOP    14.0
#define BOTTOM 52.0

#define LETTER_WIDTH  6.3 /* average over the letters of a name */
#define LETTER_HEIGHT 13.0
#define TICKS_MAX     32
#define CURVE_POINTS  40 /* a line with more points is drawn without marks */

struct axis {
    double low, high; /* values at the axis's ends */
    bool logarithmic;
    double from, to; /* coordinates of the ends */
};

struct box {
    double x0, y0, x1, y1;
};

struct plot_drawing {
    FILE *out;
    const struct tl_plot_options *options;
    double height;
    struct axis x, y;
    struct box *occupied; /* boxes of marks and names drawn so far */
    size_t occupied_count;
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

/* An axis that holds all values and a margin; a linear axis includes 0. */
static struct axis make_axis(double low, double high, bool logarithmic, bool tight, double from, double to)
{
    const double margin_share = tight ? 0 : 0.07;
    struct axis axis = {low, high, logarithmic, from, to};
    if (low > high) { /* no value is in range */
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

static void find_axes(struct plot_drawing *drawing, const struct tl_plot *plot)
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
    for (size_t i = 0; i < drawing->options->guide_count; i++) {
        low[1] = fmin(low[1], drawing->options->guides[i].y);
        high[1] = fmax(high[1], drawing->options->guides[i].y);
    }
    drawing->x = make_axis(low[0], high[0], plot->x_log, drawing->options->x_tight, LEFT, WIDTH - RIGHT);
    drawing->y = make_axis(low[1], high[1], plot->y_log, false, drawing->height - BOTTOM, TOP);
}

struct tick {
    double value;
    bool labelled;
};

/* Ticks at 1, 2 and 5 times each power of ten. Over many decades only the powers of ten have labels. */
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

/* Ticks at round steps, as many as fit with `room` units between them. */
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
                     : count; /* a range within one decade holds too few of the round numbers */
}

static void print_y_ticks(const struct plot_drawing *drawing)
{
    struct tick ticks[TICKS_MAX];
    size_t count = find_ticks(&drawing->y, drawing->options->y_is_count, ticks);
    for (size_t i = 0; i < count; i++) {
        double at = place(&drawing->y, ticks[i].value);
        fprintf(drawing->out, "<line class=\"grid\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n",
                LEFT, at, WIDTH - RIGHT, at);
        if (ticks[i].labelled)
            fprintf(drawing->out,
                    "<text class=\"tick\" text-anchor=\"end\" x=\"%.1f\" y=\"%.1f\">%.4g</text>\n", LEFT - 7,
                    at + 4, ticks[i].value);
    }
}

static void print_axes(const struct plot_drawing *drawing, const struct tl_plot *plot)
{
    struct tick ticks[TICKS_MAX];
    FILE *out = drawing->out;
    size_t count = find_ticks(&drawing->x, false, ticks);
    for (size_t i = 0; i < count; i++) {
        double at = place(&drawing->x, ticks[i].value);
        fprintf(out, "<line class=\"grid\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>\n", at, TOP, at,
                drawing->height - BOTTOM);
        if (ticks[i].labelled)
            fprintf(out, "<text class=\"tick\" text-anchor=\"middle\" x=\"%.1f\" y=\"%.1f\">%.4g</text>\n",
                    at, drawing->height - BOTTOM + 16, ticks[i].value);
    }
    if (!drawing->options->y_unlabelled)
        print_y_ticks(drawing);
    fprintf(out, "<path class=\"frame\" d=\"M%.1f %.1fV%.1fH%.1f\"/>\n", LEFT, TOP, drawing->height - BOTTOM,
            WIDTH - RIGHT);
    fprintf(out, "<text class=\"axis\" text-anchor=\"middle\" x=\"%.1f\" y=\"%.1f\">",
            0.5 * (LEFT + WIDTH - RIGHT), drawing->height - 10);
    tl_html_print(out, plot->x_label);
    fprintf(
        out,
        "</text>\n<text class=\"axis\" text-anchor=\"middle\" transform=\"translate(15 %.1f) rotate(-90)\">",
        0.5 * (TOP + drawing->height - BOTTOM));
    tl_html_print(out, plot->y_label);
    fputs("</text>\n", out);
}

/* SVG paths of the marks, of about equal area, centred at 0: disc, square, diamond, triangles, cross, bars.
 */
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

static void occupy(struct plot_drawing *drawing, struct box box)
{
    drawing->occupied[drawing->occupied_count++] = box;
}

/* Joins the points; an area is closed along the lower end of y. */
static void print_line(const struct plot_drawing *drawing, const struct tl_plot *plot,
                       const struct tl_plot_series *series, size_t style)
{
    bool steps = drawing->options->kind == TL_PLOT_STEPS, areas = drawing->options->kind == TL_PLOT_AREAS;
    bool begun = false;
    double first = 0, last = 0;
    for (size_t i = 0; i < series->count; i++) {
        const struct tl_plot_point *point = &series->points[i];
        if (!usable(plot, point))
            continue;
        if (!begun && series->front)
            fputs("<path class=\"front\" d=\"M", drawing->out);
        else if (!begun)
            fprintf(drawing->out, "<path class=\"%s s%zu\" d=\"M", areas ? "area" : "line", style);
        else if (!steps)
            fputc('L', drawing->out);
        double x = place(&drawing->x, point->x), y = place(&drawing->y, point->y);
        if (begun && steps)
            fprintf(drawing->out, "H%.1fV%.1f", x, y);
        else
            fprintf(drawing->out, "%.1f %.1f", x, y);
        first = begun ? first : x;
        last = x;
        begun = true;
    }
    if (begun && areas)
        fprintf(drawing->out, "L%.1f %.1fH%.1fZ", last, place(&drawing->y, drawing->y.low), first);
    if (begun)
        fputs("\"/>\n", drawing->out);
}

static void print_bars(const struct plot_drawing *drawing, const struct tl_plot *plot,
                       const struct tl_plot_series *series, size_t style)
{
    double floor_y = place(&drawing->y, drawing->y.low);
    for (size_t i = 0; i < series->count; i++) {
        const struct tl_plot_point *point = &series->points[i];
        if (!usable(plot, point))
            continue;
        double from = place(&drawing->x, point->x - 0.5 * drawing->options->bar_width),
               to = place(&drawing->x, point->x + 0.5 * drawing->options->bar_width),
               top = place(&drawing->y, point->y);
        fprintf(drawing->out,
                "<rect class=\"mark s%zu\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"><title>",
                style, from, top, to - from, floor_y - top);
        tl_html_print(drawing->out, point->name);
        fputs("</title></rect>\n", drawing->out);
    }
}

static void print_shade(const struct plot_drawing *drawing)
{
    if (drawing->options->shaded_to > drawing->x.low)
        fprintf(drawing->out,
                "<rect class=\"shade\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"/>\n", LEFT, TOP,
                place(&drawing->x, fmin(drawing->options->shaded_to, drawing->x.high)) - LEFT,
                drawing->height - BOTTOM - TOP);
}

static void print_guides(const struct plot_drawing *drawing)
{
    const struct tl_plot_options *options = drawing->options;
    for (size_t i = 0; i < options->guide_count; i++) {
        double y = place(&drawing->y, options->guides[i].y);
        fprintf(drawing->out, "<path class=\"%s\" d=\"M%.1f %.1fH%.1f\"/>\n",
                options->y_unlabelled ? "grid" : "guide", LEFT, y, WIDTH - RIGHT);
        if (options->y_unlabelled)
            continue;
        fprintf(drawing->out, "<text class=\"name\" text-anchor=\"end\" x=\"%.1f\" y=\"%.1f\">",
                WIDTH - RIGHT - 4, y - 5);
        tl_html_print(drawing->out, options->guides[i].name);
        fputs("</text>\n", drawing->out);
    }
}

static void print_marks(struct plot_drawing *drawing, const struct tl_plot *plot,
                        const struct tl_plot_series *series, size_t style)
{
    for (size_t i = 0; i < series->count; i++) {
        const struct tl_plot_point *point = &series->points[i];
        if (!usable(plot, point))
            continue;
        double x = place(&drawing->x, point->x), y = place(&drawing->y, point->y);
        occupy(drawing, (struct box){x - 4, y - 4, x + 4, y + 4});
        fprintf(drawing->out, "<path class=\"mark s%zu\" transform=\"translate(%.1f %.1f)\" d=\"%s\"><title>",
                style, x, y, marks[style]);
        tl_html_print(drawing->out, point->name);
        fprintf(drawing->out, " (%.4g, %.4g)</title></path>\n", point->x, point->y);
    }
}

static bool overlaps(const struct plot_drawing *drawing, struct box box)
{
    if (box.x0 < LEFT || box.x1 > WIDTH || box.y0 < 0 || box.y1 > drawing->height - BOTTOM)
        return true;
    for (size_t i = 0; i < drawing->occupied_count; i++) {
        const struct box *other = &drawing->occupied[i];
        if (box.x0 < other->x1 && box.x1 > other->x0 && box.y0 < other->y1 && box.y1 > other->y0)
            return true;
    }
    return false;
}

/* Writes a name beside its point, at the first of eight places where it covers no mark or other name. Without
 * such a place the name only shows when the point is hovered. */
static void print_name(struct plot_drawing *drawing, const struct tl_plot_point *point)
{
    static const double sides[][2] = {{1, 0}, {-1, 0}, {0, -1}, {0, 1}, {1, -1}, {-1, -1}, {1, 1}, {-1, 1}};
    const double gap = 7;
    double x = place(&drawing->x, point->x), y = place(&drawing->y, point->y);
    double width = LETTER_WIDTH * (double)strlen(point->name), height = LETTER_HEIGHT;
    for (size_t i = 0; i < TL_COUNT(sides); i++) {
        double left = sides[i][0] > 0 ? x + gap : sides[i][0] < 0 ? x - gap - width : x - 0.5 * width;
        double middle = y + sides[i][1] * (gap + 0.5 * height);
        struct box box = {left, middle - 0.5 * height, left + width, middle + 0.5 * height};
        if (overlaps(drawing, box))
            continue;
        occupy(drawing, box);
        fprintf(drawing->out, "<text class=\"name\" x=\"%.1f\" y=\"%.1f\">", left, middle + 4);
        tl_html_print(drawing->out, point->name);
        fputs("</text>\n", drawing->out);
        return;
    }
}

static void print_names(struct plot_drawing *drawing, const struct tl_plot *plot)
{
    for (size_t s = 0; s < plot->series_count; s++)
        for (size_t i = 0; !plot->series[s].front && i < plot->series[s].count; i++) {
            const struct tl_plot_point *point = &plot->series[s].points[i];
            if (point->named && usable(plot, point))
                print_name(drawing, point);
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

/* Areas are drawn before the grid, so that its lines show on them; other series are drawn after it. */
static void print_series(struct plot_drawing *drawing, const struct tl_plot *plot)
{
    enum tl_plot_kind kind = drawing->options->kind;
    for (size_t s = plot->series_count; s-- > 0 && kind == TL_PLOT_AREAS;)
        print_line(drawing, plot, &plot->series[s], s % TL_PLOT_STYLES);
    print_axes(drawing, plot);
    for (size_t s = 0; s < plot->series_count; s++) {
        if (kind == TL_PLOT_BARS)
            print_bars(drawing, plot, &plot->series[s], s % TL_PLOT_STYLES);
        if (is_joined(&plot->series[s], kind))
            print_line(drawing, plot, &plot->series[s], s % TL_PLOT_STYLES);
    }
    for (size_t s = 0; s < plot->series_count; s++)
        if (has_marks(&plot->series[s], kind))
            print_marks(drawing, plot, &plot->series[s], s % TL_PLOT_STYLES);
}

void tl_plot_print(FILE *out, const struct tl_plot *plot, const struct tl_plot_options *options)
{
    size_t points = 0;
    for (size_t s = 0; s < plot->series_count; s++)
        points += plot->series[s].count;
    struct plot_drawing drawing = {.out = out,
                                   .options = options,
                                   .height = options->height > 0 ? options->height : HEIGHT,
                                   .occupied = TL_NEW_ARRAY(struct box, 2 * points)};
    find_axes(&drawing, plot);
    if (plot->series_count > 1 || options->kind == TL_PLOT_LINES)
        print_legend(out, plot);
    fprintf(out, "<svg class=\"plot\" viewBox=\"0 0 %.0f %.0f\" role=\"img\">\n", WIDTH, drawing.height);
    print_shade(&drawing);
    print_series(&drawing, plot);
    print_guides(&drawing);
    print_names(&drawing, plot);
    fputs("</svg>\n", out);
    free(drawing.occupied);
}

struct ranked_point {
    size_t index;
    double x, y;
};

static int compare_ranked(const void *a, const void *b)
{
    const struct ranked_point *first = a, *second = b;
    if (first->x != second->x)
        return first->x < second->x ? -1 : 1;
    return (first->y > second->y) - (first->y < second->y);
}

size_t tl_pareto_front(const struct tl_plot_point *points, size_t count, size_t *best)
{
    struct ranked_point *ranked = TL_NEW_ARRAY(struct ranked_point, count);
    size_t usable_count = 0, front = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(points[i].x) && isfinite(points[i].y))
            ranked[usable_count++] = (struct ranked_point){i, points[i].x, points[i].y};
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
