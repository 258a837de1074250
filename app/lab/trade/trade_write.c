#include "app/lab/trade/trade.h"
#include "app/lab/trade/trade_light.h"
#include "app/report/cells.h"
#include "app/report/report.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MEBIBYTE 1048576.0

static const char *choice_name(const char *key, int index)
{
    return tl_experiment_choices(&tl_light_options, key)[index];
}

void tl_trade_write_csv(const struct tl_trade *trade, FILE *out)
{
    fputs("group,name,look,state,draws,budget_ms,width,height,scale,method,visibility,prefilter,composition,"
          "cut,regions,"
          "map_size_texels,"
          "filter,cpu_ms_per_frame,wall_ms_per_frame,pem_bytes,map_bytes,total_bytes,relative_rmse,standard_"
          "error,mean_flip,"
          "largest_difference,covered_pixels,garment_flip,garment_flip_worst,garment_pixels\n",
          out);
    for (size_t i = 0; i < trade->row_count; i++) {
        const struct tl_trade_row *row = &trade->rows[i];
        const struct tl_light_params *light = &row->settings.light;
        fprintf(
            out,
            "\"%s\",\"%s\",%s,%s,%d,%g,%d,%d,%g,%s,%s,%s,%s,%s,%d,%d,%s,%.3f,%.3f,%zu,%zu,%zu,%.6g,%.6g,%."
            "6g,%.6g,%zu",
            row->group, row->name, trade->experiment->appearances[row->appearance].name,
            row->rest ? "rest" : "moving", row->draws, row->budget_ms, row->settings.image.width,
            row->settings.image.height, (double)row->settings.image.scale,
            choice_name("method", light->method), choice_name("visibility", light->visibility),
            choice_name("prefilter", light->prefilter), choice_name("composition", light->composition),
            choice_name("cut", light->cut), light->regions, light->map_size,
            choice_name("filter", light->filter), row->taken.cpu_ms, row->taken.wall_ms, row->memory.pems,
            row->memory.maps, row->memory.total, row->error.rel_rmse, row->error.standard_error,
            row->error.flip_mean, row->error.max_abs, row->error.covered);
        if (row->error.garment.pixels)
            fprintf(out, ",%.6g,%.6g,%zu\n", row->error.garment.flip_mean, row->error.garment.flip_worst,
                    row->error.garment.pixels);
        else
            fputs(",,,\n", out);
    }
}

/* The row of the same technique under another appearance, or at rest (after the most draws). */
static const struct tl_trade_row *sibling(const struct tl_trade *trade, const struct tl_trade_row *of,
                                          int appearance, bool rest)
{
    const struct tl_trade_row *found = NULL;
    for (const struct tl_trade_row *row = NULL;
         (row = tl_trade_next(trade, row, of->group, appearance, rest));)
        if (strcmp(row->name, of->name) == 0)
            found = row;
    return found;
}

static void add_error_cell(const struct tl_trade *trade, struct tl_cells *cells,
                           const struct tl_trade_row *row)
{
    if (row && trade->experiment->by_flip)
        tl_cells_add(cells, "%.4f / %.3f", row->error.garment.flip_mean, row->error.garment.flip_worst);
    else if (row)
        tl_cells_add(cells, "%.2f %% / %.3f", 100 * row->error.rel_rmse, row->error.flip_mean);
    else
        tl_cells_add(cells, "-");
}

/* One group's names, times under one appearance, and errors under all. */
static void print_group_table(const struct tl_trade *trade, const char *group, int appearance, FILE *out)
{
    static const char *const heads[] = {"", "CPU ms", "wall ms", "at rest", "MiB"};
    struct tl_cells cells = {0};
    for (size_t i = 0; i < TL_COUNT(heads); i++)
        tl_cells_add(&cells, "%s", heads[i]);
    size_t columns = TL_COUNT(heads);
    bool shown[TL_EXPERIMENT_APPEARANCES] = {false};
    for (int l = 0; l < trade->experiment->appearance_count; l++) {
        shown[l] = tl_trade_next(trade, NULL, group, l, false) != NULL;
        if (!shown[l])
            continue;
        tl_cells_add(&cells, "%s, moving", trade->experiment->appearances[l].title);
        tl_cells_add(&cells, "at rest");
        columns += 2;
    }
    for (const struct tl_trade_row *row = NULL;
         (row = tl_trade_next(trade, row, group, appearance, false));) {
        const struct tl_trade_row *rest = sibling(trade, row, appearance, true);
        tl_cells_add(&cells, "%s", row->name);
        tl_cells_add(&cells, "%.1f", row->taken.cpu_ms);
        tl_cells_add(&cells, "%.1f", row->taken.wall_ms);
        tl_cells_add(&cells, "%.1f", rest ? rest->taken.cpu_ms : NAN);
        tl_cells_add(&cells, "%.1f", (double)row->memory.total / MEBIBYTE);
        for (int l = 0; l < trade->experiment->appearance_count; l++)
            if (shown[l]) {
                add_error_cell(trade, &cells, sibling(trade, row, l, false));
                add_error_cell(trade, &cells, sibling(trade, row, l, true));
            }
    }
    tl_cells_print(&cells, columns, out);
}

static double time_of(const struct tl_trade *trade, const struct tl_trade_row *row)
{
    return trade->experiment->by_wall ? row->taken.wall_ms : row->taken.cpu_ms;
}

static double error_of(const struct tl_trade *trade, const struct tl_trade_row *row)
{
    return trade->experiment->by_flip ? row->error.garment.flip_mean : 100 * row->error.rel_rmse;
}

/* Points of a plot by group, with room for the Pareto front. */
struct scatter {
    struct tl_plot_point *points; /* all, group after group */
    const struct tl_trade_row **rows;
    size_t count;
    struct tl_plot_series series[TL_PLOT_STYLES + 1];
    size_t series_count;
    size_t *front;
    struct tl_plot_point *front_points;
    size_t front_count;
};

/* Error against time of all variants in motion at one appearance. */
static void make_scatter(const struct tl_trade *trade, int appearance, struct scatter *out)
{
    *out = (struct scatter){.points = TL_NEW_ARRAY(struct tl_plot_point, trade->row_count),
                            .rows = TL_NEW_ARRAY(const struct tl_trade_row *, trade->row_count),
                            .front = TL_NEW_ARRAY(size_t, trade->row_count),
                            .front_points = TL_NEW_ARRAY(struct tl_plot_point, trade->row_count)};
    const char *group = NULL;
    for (const struct tl_trade_row *row = NULL; (row = tl_trade_next(trade, row, NULL, appearance, false));) {
        if (!group || strcmp(group, row->group) != 0) {
            group = row->group;
            out->series[out->series_count++] =
                (struct tl_plot_series){.name = group, .points = &out->points[out->count]};
        }
        out->series[out->series_count - 1].count++;
        out->rows[out->count] = row;
        out->points[out->count++] = (struct tl_plot_point){time_of(trade, row), error_of(trade, row),
                                                           row->name, strcmp(row->group, "presets") == 0};
    }
    out->front_count = tl_pareto_front(out->points, out->count, out->front);
    for (size_t i = 0; i < out->front_count; i++) {
        out->points[out->front[i]].named = true;
        out->front_points[i] = out->points[out->front[i]];
    }
    out->series[out->series_count++] = (struct tl_plot_series){
        .name = "Pareto front", .points = out->front_points, .count = out->front_count, .front = true};
}

static void release_scatter(struct scatter *scatter)
{
    free(scatter->points);
    free(scatter->rows);
    free(scatter->front);
    free(scatter->front_points);
}

static void print_front(const struct tl_trade *trade, const struct scatter *scatter, FILE *out)
{
    bool garment = trade->experiment->by_flip;
    const char *const heads[] = {"on the Pareto front",
                                 "CPU ms",
                                 "wall ms",
                                 garment ? "FLIP of the garment" : "rel. RMSE",
                                 garment ? "of its worst 5 %" : "mean FLIP",
                                 "MiB"};
    struct tl_cells cells = {0};
    for (size_t i = 0; i < TL_COUNT(heads); i++)
        tl_cells_add(&cells, "%s", heads[i]);
    for (size_t i = 0; i < scatter->front_count; i++) {
        const struct tl_trade_row *row = scatter->rows[scatter->front[i]];
        tl_cells_add(&cells, "%s", row->name);
        tl_cells_add(&cells, "%.1f", row->taken.cpu_ms);
        tl_cells_add(&cells, "%.1f", row->taken.wall_ms);
        if (garment) {
            tl_cells_add(&cells, "%.4f", row->error.garment.flip_mean);
            tl_cells_add(&cells, "%.3f", row->error.garment.flip_worst);
        } else {
            tl_cells_add(&cells, "%.2f %%", 100 * row->error.rel_rmse);
            tl_cells_add(&cells, "%.4f", row->error.flip_mean);
        }
        tl_cells_add(&cells, "%.1f", (double)row->memory.total / MEBIBYTE);
    }
    tl_cells_print(&cells, TL_COUNT(heads), out);
}

static void print_scatters(const struct tl_trade *trade, FILE *out)
{
    tl_report_heading(out, "Error against time, in motion");
    tl_report_paragraph(out, trade->experiment->text);
    bool garment = trade->experiment->by_flip;
    const char *measure = garment ? "FLIP of the garment" : "relative RMSE, %";
    for (int appearance = 0; appearance < trade->experiment->appearance_count; appearance++) {
        const struct tl_trade_row *any = tl_trade_next(trade, NULL, NULL, appearance, false);
        if (!any)
            continue;
        struct scatter scatter;
        make_scatter(trade, appearance, &scatter);
        char caption[300];
        snprintf(caption, sizeof caption,
                 "%c%s, %d x %d pixels. Errors over %s pixels against the reference.",
                 trade->experiment->appearances[appearance].title[0] - 'a' + 'A',
                 trade->experiment->appearances[appearance].title + 1, any->settings.image.width,
                 any->settings.image.height, garment ? "the garment's" : "covered");
        tl_report_plot(out,
                       &(struct tl_plot){trade->experiment->by_wall ? "wall time of a frame, ms"
                                                                    : "CPU ms a frame, all threads",
                                         measure, true, true, scatter.series, scatter.series_count},
                       caption);
        print_front(trade, &scatter, out);
        release_scatter(&scatter);
    }
}

static void print_pictures(const struct tl_trade *trade, FILE *out)
{
    for (int appearance = 0; appearance < trade->experiment->appearance_count; appearance++) {
        bool begun = false;
        for (size_t i = 0; i < trade->picture_count; i++) {
            const struct tl_trade_picture *picture = &trade->pictures[i];
            char text[120] = "ray traced";
            if (picture->appearance != appearance)
                continue;
            if (!begun) {
                snprintf(text, sizeof text, "Side by side: %s",
                         trade->experiment->appearances[appearance].title);
                tl_report_heading(out, text);
                tl_report_pictures_begin(out);
                begun = true;
            }
            snprintf(text, sizeof text, "ray traced");
            if (picture->error.garment.pixels)
                snprintf(text, sizeof text, "FLIP of the garment %.3f, of its worst 5 %% %.3f",
                         picture->error.garment.flip_mean, picture->error.garment.flip_worst);
            else if (picture->error.covered)
                snprintf(text, sizeof text, "%.1f %% relative RMSE, FLIP %.3f", 100 * picture->error.rel_rmse,
                         picture->error.flip_mean);
            tl_report_picture(out, picture->png, picture->size, picture->name, text);
        }
        if (begun)
            tl_report_pictures_end(out);
    }
}

static void print_tables(const struct tl_trade *trade, int appearance, FILE *out)
{
    tl_report_heading(out, "All figures");
    tl_report_paragraph(
        out, trade->experiment->by_flip
                 ? "Errors are FLIP of the picture as shown over the garment's pixels, and over the "
                   "worst 5 % of them, against the reference; times are medians."
                 : "Errors are relative RMSE and mean FLIP over covered pixels against the "
                   "reference; times are medians of process CPU time; at rest, of the last frames "
                   "averaged.");
    const char *group = NULL;
    for (const struct tl_trade_row *row = NULL; (row = tl_trade_next(trade, row, NULL, appearance, false));) {
        if (group && strcmp(group, row->group) == 0)
            continue;
        group = row->group;
        tl_report_paragraph(out, group);
        print_group_table(trade, group, appearance, out);
    }
    for (size_t i = 0; i < trade->refusal_count; i++)
        tl_report_paragraph(out, trade->refusals[i]);
}

void tl_trade_write_html(const struct tl_trade *trade, FILE *out)
{
    char subtitle[400];
    snprintf(subtitle, sizeof subtitle,
             "toile trade --axis %s: %zu garment triangles that move %.1f mm a frame on average, environment "
             "%.120s%s",
             trade->experiment->name, trade->recording.garment_triangles, 1e3 * trade->recording.mean_step_m,
             trade->environment->name, trade->complete ? "" : "; interrupted: what was measured until then");
    tl_report_begin(out, trade->experiment->title, subtitle);
    print_scatters(trade, out);
    print_pictures(trade, out);
    if (strcmp(trade->experiment->name, "light") == 0)
        tl_trade_write_light_figures(trade, out);
    print_tables(trade, trade->quick ? trade->experiment->quick_appearance : 0, out);
    tl_report_end(out);
}
