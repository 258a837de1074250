#include "app/cells.h"
#include "app/report.h"
#include "app/trade_light.h"
#include "app/trade_light_figures.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MEBIBYTE 1048576.0

static const char *choice_name(const char *key, int index)
{
    for (size_t i = 0; i < tl_light_options.row_count; i++)
        if (strcmp(tl_light_options.rows[i].name, key) == 0)
            return tl_light_options.rows[i].choices[index];
    return "";
}

void tl_trade_write_csv(const struct tl_trade *trade, FILE *out)
{
    fputs("group,name,look,state,draws,method,visibility,prefilter,composition,cut,regions,map_size_texels,"
          "filter,cpu_ms_per_frame,wall_ms_per_frame,pem_bytes,map_bytes,total_bytes,relative_rmse,standard_"
          "error,mean_flip,"
          "largest_difference,covered_pixels\n",
          out);
    for (size_t i = 0; i < trade->row_count; i++) {
        const struct tl_trade_row *row = &trade->rows[i];
        const struct tl_light_params *light = &row->light;
        fprintf(
            out,
            "\"%s\",\"%s\",%s,%s,%d,%s,%s,%s,%s,%s,%d,%d,%s,%.3f,%.3f,%zu,%zu,%zu,%.6g,%.6g,%.6g,%.6g,%zu\n",
            row->group, row->name, tl_looks[row->look].name, row->rest ? "rest" : "moving", row->draws,
            choice_name("method", light->method), choice_name("visibility", light->visibility),
            choice_name("prefilter", light->prefilter), choice_name("composition", light->composition),
            choice_name("cut", light->cut), light->regions, light->map_size,
            choice_name("filter", light->filter), row->taken.cpu_ms, row->taken.wall_ms, row->memory.pems,
            row->memory.maps, row->memory.total, row->error.rel_rmse, row->error.standard_error,
            row->error.flip_mean, row->error.max_abs, row->error.covered);
    }
}

/* Of a group (NULL: any), in order. `after` NULL begins; returns NULL at the end. */
static const struct tl_trade_row *next_row(const struct tl_trade *trade, const struct tl_trade_row *after,
                                           const char *group, int look, bool rest)
{
    const struct tl_trade_row *end = trade->rows + trade->row_count;
    for (const struct tl_trade_row *row = after ? after + 1 : trade->rows; row < end; row++)
        if (row->look == look && row->rest == rest && (!group || strcmp(row->group, group) == 0))
            return row;
    return NULL;
}

/* A contender's row in another look, or where it came to rest (after the most draws). */
static const struct tl_trade_row *sibling(const struct tl_trade *trade, const struct tl_trade_row *of,
                                          int look, bool rest)
{
    const struct tl_trade_row *found = NULL;
    for (const struct tl_trade_row *row = NULL; (row = next_row(trade, row, of->group, look, rest));)
        if (strcmp(row->name, of->name) == 0)
            found = row;
    return found;
}

static void add_error_cell(struct tl_cells *cells, const struct tl_trade_row *row)
{
    if (row)
        tl_cells_add(cells, "%.2f %% / %.3f", 100 * row->error.rel_rmse, row->error.flip_mean);
    else
        tl_cells_add(cells, "-");
}

/* Names of one group, what they take at one look, and their errors in all. */
static void print_group_table(const struct tl_trade *trade, const char *group, int look, FILE *out)
{
    static const char *const heads[] = {"", "CPU ms", "at rest", "MiB"};
    struct tl_cells cells = {0};
    for (size_t i = 0; i < TL_COUNT(heads); i++)
        tl_cells_add(&cells, "%s", heads[i]);
    size_t columns = TL_COUNT(heads);
    bool shown[TL_LOOK_COUNT];
    for (int l = 0; l < TL_LOOK_COUNT; l++) {
        shown[l] = next_row(trade, NULL, group, l, false) != NULL;
        if (!shown[l])
            continue;
        tl_cells_add(&cells, "%s, moving", tl_looks[l].title);
        tl_cells_add(&cells, "at rest");
        columns += 2;
    }
    for (const struct tl_trade_row *row = NULL; (row = next_row(trade, row, group, look, false));) {
        const struct tl_trade_row *rest = sibling(trade, row, look, true);
        tl_cells_add(&cells, "%s", row->name);
        tl_cells_add(&cells, "%.1f", row->taken.cpu_ms);
        tl_cells_add(&cells, "%.1f", rest ? rest->taken.cpu_ms : NAN);
        tl_cells_add(&cells, "%.1f", (double)row->memory.total / MEBIBYTE);
        for (int l = 0; l < TL_LOOK_COUNT; l++)
            if (shown[l]) {
                add_error_cell(&cells, sibling(trade, row, l, false));
                add_error_cell(&cells, sibling(trade, row, l, true));
            }
    }
    tl_cells_print(&cells, columns, out);
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

/* Error against time of all contenders in motion at one look. */
static void make_scatter(const struct tl_trade *trade, int look, struct scatter *out)
{
    *out = (struct scatter){.points = TL_NEW_ARRAY(struct tl_plot_point, trade->row_count),
                            .rows = TL_NEW_ARRAY(const struct tl_trade_row *, trade->row_count),
                            .front = TL_NEW_ARRAY(size_t, trade->row_count),
                            .front_points = TL_NEW_ARRAY(struct tl_plot_point, trade->row_count)};
    const char *group = NULL;
    for (const struct tl_trade_row *row = NULL; (row = next_row(trade, row, NULL, look, false));) {
        if (!group || strcmp(group, row->group) != 0) {
            group = row->group;
            out->series[out->series_count++] =
                (struct tl_plot_series){.name = group, .points = &out->points[out->count]};
        }
        out->series[out->series_count - 1].count++;
        out->rows[out->count] = row;
        out->points[out->count++] = (struct tl_plot_point){row->taken.cpu_ms, 100 * row->error.rel_rmse,
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

static void print_front(const struct scatter *scatter, FILE *out)
{
    static const char *const heads[] = {"on the Pareto front", "CPU ms", "rel. RMSE", "mean FLIP", "MiB"};
    struct tl_cells cells = {0};
    for (size_t i = 0; i < TL_COUNT(heads); i++)
        tl_cells_add(&cells, "%s", heads[i]);
    for (size_t i = 0; i < scatter->front_count; i++) {
        const struct tl_trade_row *row = scatter->rows[scatter->front[i]];
        tl_cells_add(&cells, "%s", row->name);
        tl_cells_add(&cells, "%.1f", row->taken.cpu_ms);
        tl_cells_add(&cells, "%.2f %%", 100 * row->error.rel_rmse);
        tl_cells_add(&cells, "%.4f", row->error.flip_mean);
        tl_cells_add(&cells, "%.1f", (double)row->memory.total / MEBIBYTE);
    }
    tl_cells_print(&cells, TL_COUNT(heads), out);
}

static void print_scatters(const struct tl_trade *trade, FILE *out)
{
    tl_report_heading(out, "Error against time, in motion");
    tl_report_paragraph(out,
                        "Down and left is better. Every mark is one choice of settings that drew the same "
                        "moving cloth; the dashed line joins those that nothing else beats in both.");
    for (int look = 0; look < TL_LOOK_COUNT; look++) {
        if (!next_row(trade, NULL, NULL, look, false))
            continue;
        struct scatter scatter;
        make_scatter(trade, look, &scatter);
        char caption[200];
        snprintf(caption, sizeof caption, "%c%s. Relative RMSE over covered pixels against the oracle.",
                 tl_looks[look].title[0] - 'a' + 'A', tl_looks[look].title + 1);
        tl_report_plot(out,
                       &(struct tl_plot){"CPU ms a frame, all threads", "relative RMSE, %", true, true,
                                         scatter.series, scatter.series_count},
                       caption);
        print_front(&scatter, out);
        release_scatter(&scatter);
    }
}

/* One line of a plot: rows of a group, x from the row's settings. */
enum axis_value { BY_REGIONS, BY_MAP_SIZE, BY_DRAWS, VALUE_CPU, VALUE_ERROR };

static double value_of(const struct tl_trade_row *row, enum axis_value which)
{
    switch (which) {
    case BY_REGIONS:
        return row->light.regions;
    case BY_MAP_SIZE:
        return row->light.map_size;
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

static void add_group_line(struct lines *lines, const struct tl_trade *trade, const char *group, int look,
                           enum axis_value x, enum axis_value y)
{
    if (!next_row(trade, NULL, group, look, false))
        return;
    begin_line(lines, trade, group);
    for (const struct tl_trade_row *row = NULL; (row = next_row(trade, row, group, look, false));)
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
    const int look = TL_LOOK_SATIN;
    tl_report_heading(out, "Regions and shadow maps");
    add_group_line(&lines, trade, "regions, paper", look, BY_REGIONS, VALUE_CPU);
    add_group_line(&lines, trade, "regions, rays", look, BY_REGIONS, VALUE_CPU);
    print_lines(&lines, "regions N", "CPU ms a frame", "Time against N, as the paper's figure 7 has it.",
                out);
    add_group_line(&lines, trade, "map size", look, BY_MAP_SIZE, VALUE_CPU);
    print_lines(&lines, "shadow map, texels a side", "CPU ms a frame", "Time against map size, N = 96.", out);
    add_group_line(&lines, trade, "regions, paper", look, BY_REGIONS, VALUE_ERROR);
    add_group_line(&lines, trade, "regions, rays", look, BY_REGIONS, VALUE_ERROR);
    print_lines(&lines, "regions N", "relative RMSE, %", "Error against N, glossiness 0.7, in motion.", out);
    add_group_line(&lines, trade, "map size", look, BY_MAP_SIZE, VALUE_ERROR);
    print_lines(&lines, "shadow map, texels a side", "relative RMSE, %",
                "Error against map size, N = 96, glossiness 0.7, in motion.", out);
}

/* How the contenders that average get nearer to the truth while nothing moves. */
static void print_rest(const struct tl_trade *trade, FILE *out)
{
    struct lines lines = {0};
    const int look = TL_LOOK_SATIN;
    for (const struct tl_trade_row *row = NULL; (row = next_row(trade, row, NULL, look, false));) {
        bool measured = strcmp(row->group, "rounds") == 0 || strcmp(row->group, "presets") == 0;
        if (!row->light.jitter || !measured || lines.series_count == TL_PLOT_STYLES)
            continue;
        begin_line(&lines, trade, row->name);
        add_point(&lines, row, BY_DRAWS, VALUE_ERROR);
        for (const struct tl_trade_row *rest = NULL; (rest = next_row(trade, rest, row->group, look, true));)
            if (strcmp(rest->name, row->name) == 0)
                add_point(&lines, rest, BY_DRAWS, VALUE_ERROR);
    }
    if (!lines.series_count)
        return;
    tl_report_heading(out, "At rest");
    print_lines(&lines, "frames drawn since the motion stopped", "relative RMSE, %",
                "Jittered directions, averaged while nothing moves. Glossiness 0.7.", out);
}

static void print_pictures(const struct tl_trade *trade, FILE *out)
{
    for (int look = 0; look < TL_LOOK_COUNT; look++) {
        bool begun = false;
        for (size_t i = 0; i < trade->picture_count; i++) {
            const struct tl_trade_picture *picture = &trade->pictures[i];
            char text[120] = "ray traced";
            if (picture->look != look)
                continue;
            if (!begun) {
                snprintf(text, sizeof text, "Side by side: %s", tl_looks[look].title);
                tl_report_heading(out, text);
                tl_report_pictures_begin(out);
                begun = true;
            }
            snprintf(text, sizeof text, "ray traced");
            if (picture->error.covered)
                snprintf(text, sizeof text, "%.1f %% relative RMSE, FLIP %.3f", 100 * picture->error.rel_rmse,
                         picture->error.flip_mean);
            tl_report_picture(out, picture->png, picture->size, picture->name, text);
        }
        if (begun)
            tl_report_pictures_end(out);
    }
}

static void print_tables(const struct tl_trade *trade, int look, FILE *out)
{
    tl_report_heading(out, "All figures");
    tl_report_paragraph(out, "Errors are relative RMSE and mean FLIP over covered pixels against the oracle; "
                             "times are medians of process CPU time; at rest, of the last frames averaged.");
    const char *group = NULL;
    for (const struct tl_trade_row *row = NULL; (row = next_row(trade, row, NULL, look, false));) {
        if (group && strcmp(group, row->group) == 0)
            continue;
        group = row->group;
        tl_report_paragraph(out, group);
        print_group_table(trade, group, look, out);
    }
    for (size_t i = 0; i < trade->refusal_count; i++)
        tl_report_paragraph(out, trade->refusals[i]);
}

void tl_trade_write_html(const struct tl_trade *trade, FILE *out)
{
    char subtitle[400];
    snprintf(subtitle, sizeof subtitle,
             "toile trade --axis light: %d x %d pixels, %zu garment triangles that move %.1f mm a frame on "
             "average, environment %.120s%s",
             trade->width, trade->height, trade->film.garment_triangles, 1e3 * trade->film.mean_step_m,
             trade->environment->name, trade->complete ? "" : "; interrupted: what was measured until then");
    tl_report_begin(out, "The trade of light: error against time", subtitle);
    int look = next_row(trade, NULL, NULL, TL_LOOK_SATIN, false) ? TL_LOOK_SATIN : TL_LOOK_MATT;
    tl_report_heading(out, "The presets");
    print_group_table(trade, "presets", look, out);
    print_scatters(trade, out);
    print_rest(trade, out);
    print_sweeps(trade, out);
    print_pictures(trade, out);
    if (trade->complete) { /* Ctrl-C asks for haste */
        tl_trade_write_lobes(trade->quick, out);
        tl_trade_write_memory(trade->environment, out);
    }
    print_tables(trade, look, out);
    tl_report_end(out);
}
