#include "app/lab/trade/trade_light.h"
#include "app/lab/trade/trade_light_figures.h"
#include "app/report/report.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One line of a plot: rows of a group, x from the row's settings. */
enum axis_value { BY_REGIONS, BY_MAP_SIZE, BY_DRAWS, VALUE_CPU, VALUE_ERROR };

static double value_of(const struct tl_trade_row *row, enum axis_value which)
{
    switch (which) {
    case BY_REGIONS:
        return row->settings.light.regions;
    case BY_MAP_SIZE:
        return row->settings.light.map_size;
    case BY_DRAWS:
        return row->draws;
    case VALUE_CPU:
        return row->taken.cpu_ms;
    case VALUE_ERROR:
        return 100 * row->error.rel_rmse;
    }
    return NAN;
}

struct lines {
    struct tl_plot_point *points;
    size_t count;
    struct tl_plot_series series[TL_PLOT_STYLES];
    size_t series_count;
};

static void begin_line(struct lines *lines, const struct tl_trade *trade, const char *name)
{
    if (!lines->points)
        lines->points = TL_NEW_ARRAY(struct tl_plot_point, TL_PLOT_STYLES * (trade->row_count + 1));
    lines->series[lines->series_count++] =
        (struct tl_plot_series){.name = name, .points = &lines->points[lines->count], .line = true};
}

static void add_point(struct lines *lines, const struct tl_trade_row *row, enum axis_value x,
                      enum axis_value y)
{
    lines->points[lines->count++] =
        (struct tl_plot_point){value_of(row, x), value_of(row, y), row->name, false};
    lines->series[lines->series_count - 1].count++;
}

static void add_group_line(struct lines *lines, const struct tl_trade *trade, const char *group,
                           int appearance, enum axis_value x, enum axis_value y)
{
    if (!tl_trade_next(trade, NULL, group, appearance, false))
        return;
    begin_line(lines, trade, group);
    for (const struct tl_trade_row *row = NULL; (row = tl_trade_next(trade, row, group, appearance, false));)
        add_point(lines, row, x, y);
}

/* A quick run leaves single points, which make no line. */
static void print_lines(struct lines *lines, const char *x_label, const char *y_label, const char *caption,
                        FILE *out)
{
    bool joined = false;
    for (size_t i = 0; i < lines->series_count; i++)
        joined |= lines->series[i].count > 1;
    if (joined)
        tl_report_plot(out,
                       &(struct tl_plot){x_label, y_label, true, true, lines->series, lines->series_count},
                       caption);
    free(lines->points);
    *lines = (struct lines){0};
}

static void print_sweeps(const struct tl_trade *trade, FILE *out)
{
    struct lines lines = {0};
    const int appearance = trade->experiment->quick_appearance; /* glossiness 0.7 */
    tl_report_heading(out, "Regions and shadow maps");
    add_group_line(&lines, trade, "regions, paper", appearance, BY_REGIONS, VALUE_CPU);
    add_group_line(&lines, trade, "regions, rays", appearance, BY_REGIONS, VALUE_CPU);
    print_lines(&lines, "regions N", "CPU ms a frame", "Time against N, as the paper's figure 7 has it.",
                out);
    add_group_line(&lines, trade, "map size", appearance, BY_MAP_SIZE, VALUE_CPU);
    print_lines(&lines, "shadow map, texels a side", "CPU ms a frame", "Time against map size, N = 96.", out);
    add_group_line(&lines, trade, "regions, paper", appearance, BY_REGIONS, VALUE_ERROR);
    add_group_line(&lines, trade, "regions, rays", appearance, BY_REGIONS, VALUE_ERROR);
    print_lines(&lines, "regions N", "relative RMSE, %", "Error against N, glossiness 0.7, in motion.", out);
    add_group_line(&lines, trade, "map size", appearance, BY_MAP_SIZE, VALUE_ERROR);
    print_lines(&lines, "shadow map, texels a side", "relative RMSE, %",
                "Error against map size, N = 96, glossiness 0.7, in motion.", out);
}

/* Error of the techniques that average over frames, while nothing moves. */
static void print_rest(const struct tl_trade *trade, FILE *out)
{
    struct lines lines = {0};
    const int appearance = trade->experiment->quick_appearance; /* glossiness 0.7 */
    for (const struct tl_trade_row *row = NULL; (row = tl_trade_next(trade, row, NULL, appearance, false));) {
        bool measured = strcmp(row->group, "rounds") == 0 || strcmp(row->group, "presets") == 0;
        if (!row->settings.light.jitter || !measured || lines.series_count == TL_PLOT_STYLES)
            continue;
        begin_line(&lines, trade, row->name);
        add_point(&lines, row, BY_DRAWS, VALUE_ERROR);
        for (const struct tl_trade_row *rest = NULL;
             (rest = tl_trade_next(trade, rest, row->group, appearance, true));)
            if (strcmp(rest->name, row->name) == 0)
                add_point(&lines, rest, BY_DRAWS, VALUE_ERROR);
    }
    if (!lines.series_count)
        return;
    tl_report_heading(out, "At rest");
    print_lines(&lines, "frames drawn since the motion stopped", "relative RMSE, %",
                "Jittered directions, averaged while nothing moves. Glossiness 0.7.", out);
}

void tl_trade_write_light_figures(const struct tl_trade *trade, FILE *out)
{
    print_rest(trade, out);
    print_sweeps(trade, out);
    if (trade->complete) { /* after Ctrl-C these slow figures are left out */
        tl_trade_write_lobes(trade->quick, out);
        tl_trade_write_memory(trade->environment, out);
    }
}
