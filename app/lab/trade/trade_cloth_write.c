#include "app/lab/trade/trade_cloth.h"
#include "app/report/cells.h"
#include "app/report/report.h"
#include "cloth/cloth.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>

/* Empty where nothing was measured. */
static void print_field(FILE *out, double value)
{
    if (isfinite(value))
        fprintf(out, ",%.6g", value);
    else
        fputc(',', out);
}

void tl_trade_cloth_write_csv(const struct tl_trade_cloth *trade, FILE *out)
{
    fputs("solver,name,side,particles,substep_s,cpu_ms_per_s,wall_ms_per_s,rms_error_m,rms_total_error_m,"
          "rest_cpu_ms,rest_wall_ms,rest_rms_error_m,rest_excess_energy_j,rest_largest_strain\n",
          out);
    for (size_t i = 0; i < trade->row_count; i++) {
        const struct tl_trade_cloth_row *row = &trade->rows[i];
        const double fields[] = {row->substep_s,     row->fall.cpu_ms, row->fall.wall_ms, row->error_m,
                                 row->total_error_m, row->rest.cpu_ms, row->rest.wall_ms, row->rest_error_m,
                                 row->rest_energy_j, row->rest_strain};
        fprintf(out, "%s,\"%s\",%d,%d", tl_cloth_solver_names[row->solver], row->name, row->side,
                row->side * row->side);
        for (size_t k = 0; k < TL_COUNT(fields); k++)
            print_field(out, fields[k]);
        fputc('\n', out);
    }
}

/* ---- Charts: points by solver, and the Pareto front ---- */

enum measure { FALL_ERROR, TOTAL_ERROR, REST_ERROR, REST_ENERGY };

static double error_of(const struct tl_trade_cloth_row *row, enum measure measure)
{
    switch (measure) {
    case FALL_ERROR:
        return 1e3 * row->error_m;
    case TOTAL_ERROR:
        return 1e3 * row->total_error_m;
    case REST_ERROR:
        return 1e3 * row->rest_error_m;
    case REST_ENERGY:
        return fabs(row->rest_energy_j);
    }
    return NAN;
}

static double cost_of(const struct tl_trade_cloth_row *row, enum measure measure)
{
    return measure == REST_ERROR || measure == REST_ENERGY ? row->rest.cpu_ms : row->fall.cpu_ms;
}

struct chart {
    struct tl_plot_point *points;
    char (*names)[64];
    const struct tl_trade_cloth_row **rows;
    size_t count;
    struct tl_plot_series series[TL_CLOTH_SOLVER_COUNT + 1];
    size_t series_count;
    size_t *front;
    struct tl_plot_point *front_points;
    size_t front_count;
};

static void add_point(struct chart *chart, const struct tl_trade_cloth_row *row, enum measure measure,
                      int side)
{
    double x = cost_of(row, measure), y = error_of(row, measure);
    if (!isfinite(x) || !(y > 0))
        return;
    if (side)
        snprintf(chart->names[chart->count], sizeof *chart->names, "%s", row->name);
    else
        snprintf(chart->names[chart->count], sizeof *chart->names, "%s, %d\u00b2", row->name, row->side);
    chart->rows[chart->count] = row;
    chart->points[chart->count] = (struct tl_plot_point){x, y, chart->names[chart->count], side != 0};
    chart->count++;
    chart->series[chart->series_count - 1].count++;
}

/* `side` 0: all sizes. */
static struct chart make_chart(const struct tl_trade_cloth *trade, enum measure measure, int side)
{
    struct chart chart = {.points = TL_NEW_ARRAY(struct tl_plot_point, trade->row_count),
                          .names = tl_alloc(trade->row_count, sizeof *chart.names),
                          .rows = TL_NEW_ARRAY(const struct tl_trade_cloth_row *, trade->row_count),
                          .front = TL_NEW_ARRAY(size_t, trade->row_count),
                          .front_points = TL_NEW_ARRAY(struct tl_plot_point, trade->row_count)};
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++) {
        chart.series[chart.series_count++] = (struct tl_plot_series){
            .name = tl_cloth_solver_names[solver], .points = &chart.points[chart.count], .line = side != 0};
        for (size_t i = 0; i < trade->row_count; i++)
            if (trade->rows[i].solver == solver && (!side || trade->rows[i].side == side))
                add_point(&chart, &trade->rows[i], measure, side);
    }
    chart.front_count = tl_pareto_front(chart.points, chart.count, chart.front);
    for (size_t i = 0; i < chart.front_count; i++) {
        chart.points[chart.front[i]].named = true;
        chart.front_points[i] = chart.points[chart.front[i]];
    }
    chart.series[chart.series_count++] = (struct tl_plot_series){
        .name = "Pareto front", .points = chart.front_points, .count = chart.front_count, .front = true};
    return chart;
}

static void release_chart(struct chart *chart)
{
    free(chart->points);
    free(chart->names);
    free(chart->rows);
    free(chart->front);
    free(chart->front_points);
}

static void print_chart(const struct chart *chart, const char *x_label, const char *y_label,
                        const char *caption, FILE *out)
{
    if (chart->count)
        tl_report_plot(out,
                       &(struct tl_plot){x_label, y_label, true, true, chart->series, chart->series_count},
                       caption);
}

/* ---- Tables ---- */

static void add_heads(struct tl_cells *cells, const char *const *heads, size_t count)
{
    for (size_t i = 0; i < count; i++)
        tl_cells_add(cells, "%s", heads[i]);
}

/* "-" where nothing was measured. */
static void add_number(struct tl_cells *cells, const char *format, double value)
{
    char text[32] = "-";
    if (isfinite(value)) /* the callers' formats are literals with one %g, %f or %e */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
        snprintf(text, sizeof text, format, value);
#pragma GCC diagnostic pop
    tl_cells_add(cells, "%s", text);
}

static void print_front(const struct chart *chart, FILE *out)
{
    static const char *const heads[] = {"on the Pareto front", "CPU ms / s", "RMS mm"};
    struct tl_cells cells = {0};
    add_heads(&cells, heads, TL_COUNT(heads));
    for (size_t i = 0; i < chart->front_count; i++) {
        const struct tl_plot_point *point = &chart->points[chart->front[i]];
        tl_cells_add(&cells, "%s", point->name);
        tl_cells_add(&cells, "%.1f", point->x);
        tl_cells_add(&cells, "%.3f", point->y);
    }
    tl_cells_print(&cells, TL_COUNT(heads), out);
}

static void print_all(const struct tl_trade_cloth *trade, FILE *out)
{
    static const char *const heads[] = {"",
                                        "vertices",
                                        "substep",
                                        "CPU ms / s",
                                        "RMS mm",
                                        "with mesh mm",
                                        "CPU ms to rest",
                                        "rest RMS mm",
                                        "energy over the reference's",
                                        "largest strain"};
    struct tl_cells cells = {0};
    add_heads(&cells, heads, TL_COUNT(heads));
    for (size_t i = 0; i < trade->row_count; i++) {
        const struct tl_trade_cloth_row *row = &trade->rows[i];
        tl_cells_add(&cells, "%s", row->name);
        tl_cells_add(&cells, "%d\u00b2", row->side);
        tl_cells_add(&cells, "%.3g ms", 1e3 * row->substep_s);
        add_number(&cells, "%.1f", row->fall.cpu_ms);
        add_number(&cells, "%.4g", 1e3 * row->error_m);
        add_number(&cells, "%.4g", 1e3 * row->total_error_m);
        add_number(&cells, "%.0f", row->rest.cpu_ms);
        add_number(&cells, "%.4g", 1e3 * row->rest_error_m);
        add_number(&cells, "%.2g J", row->rest_energy_j);
        add_number(&cells, "%.2f %%", 100 * row->rest_strain);
    }
    tl_cells_print(&cells, TL_COUNT(heads), out);
}

static void print_sizes(const struct tl_trade_cloth *trade, FILE *out)
{
    int side = 0;
    for (size_t i = 0; i < trade->row_count; i++) {
        char caption[160];
        if (trade->rows[i].side == side)
            continue;
        side = trade->rows[i].side;
        struct chart fall = make_chart(trade, FALL_ERROR, side), rest = make_chart(trade, REST_ERROR, side);
        snprintf(caption, sizeof caption,
                 "%d x %d vertices, falling: against the same mesh, converged in time, after 0.5 s.", side,
                 side);
        print_chart(&fall, "CPU ms per simulated second", "RMS of positions, mm", caption, out);
        snprintf(caption, sizeof caption,
                 "%d x %d vertices at rest, held by two corners: against the reference's rest.", side, side);
        print_chart(&rest, "CPU ms to come to rest", "RMS of positions, mm", caption, out);
        release_chart(&fall);
        release_chart(&rest);
    }
}

void tl_trade_cloth_write_html(const struct tl_trade_cloth *trade, FILE *out)
{
    char text[400];
    snprintf(text, sizeof text,
             "toile trade --axis cloth: a sheet of 1 m of the default fabric, CPU time of one core%s",
             trade->complete ? "" : "; interrupted: what was measured until then");
    tl_report_begin(out, "The trade of cloth: error against time", text);
    tl_report_heading(out, "All solvers, sizes and settings");
    snprintf(text, sizeof text,
             "Down and left is better. A level sheet, clamped by an edge, falls for 0.5 s without damping; "
             "compared with %d x %d vertices solved by the reference at half its own step (whose step still "
             "moves it by %.2g mm). Detail that a mesh is too coarse for counts as error.",
             trade->truth_side, trade->truth_side, 1e3 * trade->truth_error_m);
    tl_report_paragraph(out, text);
    struct chart chart = make_chart(trade, TOTAL_ERROR, 0);
    print_chart(&chart, "CPU ms per simulated second", "RMS of positions, mm",
                "Every mark is one solver at one size with one setting; the dashed line joins those that "
                "nothing else beats in both.",
                out);
    print_front(&chart, out);
    release_chart(&chart);
    tl_trade_fit_write_html(&trade->fit, out);
    tl_report_heading(out, "Size by size");
    tl_report_paragraph(out,
                        "A drape comes to rest as a garment does before its first frame: preview brings it "
                        "near, the solver ends it. Of equal drapes that are each other's mirror image the "
                        "nearer one counts. What lies "
                        "on the reference itself has no place on a logarithmic axis.");
    print_sizes(trade, out);
    tl_report_heading(out, "All figures");
    print_all(trade, out);
    for (size_t i = 0; i < trade->refusal_count; i++)
        tl_report_paragraph(out, trade->refusals[i]);
    tl_report_end(out);
}
