/* toile bench light and shading: the trade of a few settings, as a table of times and errors. */
#include "app/cli/json.h"
#include "app/lab/experiments/experiments.h"
#include "app/lab/trade/bench.h"
#include "app/lab/trade/trade.h"

#include <stdio.h>
#include <string.h>

#define MEBIBYTE 1048576.0

/* The row of a technique: in motion, or after the most draws at rest. */
static const struct tl_trade_row *find_row(const struct tl_trade *trade, const char *name, bool rest)
{
    const struct tl_trade_row *found = NULL;
    for (size_t i = 0; i < trade->row_count; i++)
        if (strcmp(trade->rows[i].name, name) == 0 && trade->rows[i].rest == rest)
            found = &trade->rows[i];
    return found;
}

/* CPU time over that of the first technique under the same appearance. */
static double ratio_of(const struct tl_trade *trade, const struct tl_trade_row *row)
{
    const struct tl_trade_row *first = trade->rows;
    while (first->appearance != row->appearance)
        first++;
    return row->taken.cpu_ms / first->taken.cpu_ms;
}

static void print_rows(const struct tl_trade *trade, bool is_light)
{
    const struct tl_trade_row *rows = trade->rows;
    for (size_t i = 0; i < trade->row_count; i++) {
        const struct tl_trade_row *row = &rows[i];
        if (i == 0 || row->appearance != rows[i - 1].appearance)
            printf("\n%-34s %10s %10s %8s %10s %10s %10s %10s\n",
                   is_light ? "" : trade->experiment->appearances[row->appearance].title, "CPU ms", "wall ms",
                   "ratio", "rel. RMSE", "one pixel", "mean FLIP", "MiB");
        char name[48];
        snprintf(name, sizeof name, row->rest ? "%s, at rest (%d)" : "%s", row->name, row->draws);
        printf("%-34s %10.1f %10.1f %8.2f %9.2f%% %9.0f%% %10.4f %10.1f\n", name, row->taken.cpu_ms,
               row->taken.wall_ms, ratio_of(trade, row), 100 * row->error.rel_rmse,
               100 * row->error.worst_share, row->error.flip_mean, (double)row->memory.total / MEBIBYTE);
    }
}

static double coverage(const struct tl_trade_row *row)
{
    return (double)row->error.covered / ((double)row->settings.image.width * row->settings.image.height);
}

static void print_table(const struct tl_trade *trade, bool is_light)
{
    const struct tl_trade_row *first = trade->rows;
    printf("%d x %d pixels, %.1f %% covered, %zu garment triangles, moving %.1f mm a frame on average, %.1f "
           "ms of the "
           "cloth's solver;\nmedians of process CPU time and of wall time; errors against the reference, "
           "whose standard "
           "error of %.2f %% is taken off; one pixel: the share of a frame's square error that its worst "
           "pixel holds; "
           "at rest: after so many draws\n",
           first->settings.image.width, first->settings.image.height, 100 * coverage(first),
           trade->recording.garment_triangles, 1e3 * trade->recording.mean_step_m,
           trade->recording.cloth_cpu_ms, 100 * first->error.standard_error);
    print_rows(trade, is_light);
    if (!is_light)
        return;
    const struct tl_trade_row *paper = find_row(trade, "paper", false),
                              *review = find_row(trade, "review", false);
    printf("\npaper takes %.1f times review's time; review has %.2f of paper's error (FLIP %.2f)\n",
           paper->taken.cpu_ms / review->taken.cpu_ms, review->error.rel_rmse / paper->error.rel_rmse,
           review->error.flip_mean / paper->error.flip_mean);
}

static void add_rows(cJSON *object, const struct tl_trade *trade, bool is_light)
{
    cJSON *rows = cJSON_AddArrayToObject(object, "rows");
    for (size_t i = 0; i < trade->row_count; i++) {
        const struct tl_trade_row *row = &trade->rows[i];
        cJSON *item = cJSON_CreateObject();
        cJSON_AddStringToObject(item, "name", row->name);
        if (!is_light)
            cJSON_AddStringToObject(item, "look", trade->experiment->appearances[row->appearance].name);
        cJSON_AddStringToObject(item, "state", row->rest ? "rest" : "moving");
        cJSON_AddNumberToObject(item, "draws", row->draws);
        cJSON_AddNumberToObject(item, "cpu_ms", row->taken.cpu_ms);
        cJSON_AddNumberToObject(item, "wall_ms", row->taken.wall_ms);
        cJSON_AddNumberToObject(item, "ratio", ratio_of(trade, row));
        cJSON_AddNumberToObject(item, "rel_rmse", row->error.rel_rmse);
        cJSON_AddNumberToObject(item, "worst_share", row->error.worst_share);
        cJSON_AddNumberToObject(item, "flip_mean", row->error.flip_mean);
        cJSON_AddNumberToObject(item, "memory_bytes", (double)row->memory.total);
        cJSON_AddItemToArray(rows, item);
    }
}

static void add_ratios(cJSON *object, const struct tl_trade *trade)
{
    const struct tl_trade_row *paper = find_row(trade, "paper", false),
                              *review = find_row(trade, "review", false),
                              *rest = find_row(trade, "review", true);
    cJSON_AddNumberToObject(object, "time_ratio", paper->taken.cpu_ms / review->taken.cpu_ms);
    cJSON_AddNumberToObject(object, "error_ratio", review->error.rel_rmse / paper->error.rel_rmse);
    cJSON_AddNumberToObject(object, "flip_ratio", review->error.flip_mean / paper->error.flip_mean);
    cJSON *at_rest = cJSON_AddObjectToObject(object, "review_at_rest");
    cJSON_AddNumberToObject(at_rest, "frames", rest->draws);
    cJSON_AddNumberToObject(at_rest, "cpu_ms", rest->taken.cpu_ms);
    cJSON_AddNumberToObject(at_rest, "rel_rmse", rest->error.rel_rmse);
    cJSON_AddNumberToObject(at_rest, "flip_mean", rest->error.flip_mean);
}

static void print_json(const struct tl_trade *trade, bool is_light)
{
    const struct tl_trade_row *first = trade->rows;
    cJSON *object = cJSON_CreateObject();
    if (is_light)
        add_ratios(object, trade);
    cJSON_AddNumberToObject(object, "width", first->settings.image.width);
    cJSON_AddNumberToObject(object, "height", first->settings.image.height);
    cJSON_AddNumberToObject(object, "coverage", coverage(first));
    cJSON_AddNumberToObject(object, "garment_triangles", (double)trade->recording.garment_triangles);
    cJSON_AddNumberToObject(object, "mean_step_m", trade->recording.mean_step_m);
    cJSON_AddNumberToObject(object, "cloth_cpu_ms", trade->recording.cloth_cpu_ms);
    cJSON_AddNumberToObject(object, "standard_error", first->error.standard_error);
    add_rows(object, trade, is_light);
    tl_json_print(object);
}

static bool measure(const char *axis, const struct tl_arguments *arguments,
                    const struct tl_trade_options *options, tl_error *error)
{
    const struct tl_experiment *experiment = tl_experiment_find(TL_OUTPUT_PAGE, axis);
    struct tl_headless headless;
    if (!tl_trade_headless(experiment, arguments, options, &headless, error))
        return false;
    struct tl_trade trade;
    bool done = tl_trade_measure(experiment, arguments, options, &headless, &trade, error);
    if (done)
        (arguments->json ? print_json : print_table)(&trade, options->as_read);
    tl_trade_release(&trade);
    tl_headless_release(&headless);
    return done;
}

bool tl_bench_light(const struct tl_arguments *arguments, tl_error *error)
{
    const struct tl_trade_options options = {
        .quick = arguments->quick, .group = "presets", .frames = 12, .as_read = true, .in_turn = true};
    return measure("light", arguments, &options, error);
}

bool tl_bench_shading(const struct tl_arguments *arguments, tl_error *error)
{
    return measure("shading", arguments, &(const struct tl_trade_options){.quick = arguments->quick}, error);
}
