/* report.html of a flight: its figures, then plots over all frames. */
#include "app/lab/flight/fly_account.h"
#include "app/report/cells.h"
#include "app/report/report.h"
#include "assets/image/image_file.h"
#include "config/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MEBIBYTE   1048576.0
#define JOBS_SHOWN (TL_PLOT_STYLES - 2) /* in a stack, between the cloth and the remainder */

static struct tl_plot_options time_options(const struct tl_flight *flight)
{
    return (struct tl_plot_options){
        .x_tight = true, .shaded_to = flight->warm_up / flight->frame_rate, .height = 300};
}

/* One value of every frame over time, on one or more lines. */
struct flight_lines {
    struct tl_plot_point *points;
    size_t count;
    struct tl_plot_series series[TL_PLOT_STYLES];
    size_t series_count;
};

static struct flight_lines make_lines(const struct tl_flight *flight)
{
    return (struct flight_lines){
        .points = TL_NEW_ARRAY(struct tl_plot_point, TL_PLOT_STYLES * (size_t)flight->count)};
}

static struct tl_plot_point *add_line(struct flight_lines *lines, const struct tl_flight *flight,
                                      const char *name)
{
    struct tl_plot_point *points = &lines->points[lines->count];
    for (int i = 0; i < flight->count; i++)
        points[i] = (struct tl_plot_point){.x = i / flight->frame_rate, .y = NAN, .name = name};
    lines->count += (size_t)flight->count;
    lines->series[lines->series_count++] =
        (struct tl_plot_series){.name = name, .points = points, .count = (size_t)flight->count, .line = true};
    return points;
}

static void print_lines(struct flight_lines *lines, const char *y_label,
                        const struct tl_plot_options *options, const char *caption, FILE *out)
{
    tl_report_plot_with(out,
                        &(struct tl_plot){.x_label = "seconds of the flight",
                                          .y_label = y_label,
                                          .series = lines->series,
                                          .series_count = lines->series_count},
                        options, caption);
    free(lines->points);
}

/* -- figures -- */

struct tiles {
    char texts[26][64];
    size_t count;
};

static void add_tile(struct tiles *tiles, const char *what, int digits, double value, const char *unit)
{
    if (!isfinite(value) || tiles->count + 2 > TL_COUNT(tiles->texts))
        return;
    snprintf(tiles->texts[tiles->count++], sizeof tiles->texts[0], "%.*f%s", value < 1000 ? digits : 0, value,
             unit);
    snprintf(tiles->texts[tiles->count++], sizeof tiles->texts[0], "%s", what);
}

static void print_tiles(const struct tl_flight_account *account, FILE *out)
{
    const struct tl_flight_figures *figures = &account->figures;
    const struct tl_flight *flight = account->flight;
    struct tiles tiles = {.count = 0};
    if (flight->budget_ms > 0) {
        add_tile(&tiles, "budget", 1, flight->budget_ms, " ms");
        add_tile(&tiles, "of frames within 1.1 x budget", 1, 100 * figures->within, " %");
    }
    add_tile(&tiles, "median frame", 1, figures->p50_ms, " ms");
    add_tile(&tiles, "95 % of frames take at most", 1, figures->p95_ms, " ms");
    add_tile(&tiles, "99 % of frames take at most", 1, figures->p99_ms, " ms");
    add_tile(&tiles, "for the cloth (median)", 1, figures->cloth_ms, " ms");
    add_tile(&tiles, "median error of predicted times", 1, 100 * figures->prediction_error, " %");
    add_tile(&tiles, "mean FLIP that levels add, estimated", 3, figures->estimated_error, "");
    add_tile(&tiles, "FLIP of the garment", 3, figures->garment_flip, "");
    add_tile(&tiles, "FLIP of its worst 5 %", 3, figures->garment_flip_worst, "");
    add_tile(&tiles, "mean FLIP of all covered pixels", 3, figures->flip_mean, "");
    add_tile(&tiles, "relative RMSE of all covered pixels", 1, 100 * figures->rel_rmse, " %");
    add_tile(&tiles, "held by the renderer", 0, (double)figures->memory_bytes / MEBIBYTE, " MiB");
    const char *cells[TL_COUNT(tiles.texts)];
    for (size_t i = 0; i < tiles.count; i++)
        cells[i] = tiles.texts[i];
    tl_report_tiles(out, cells, tiles.count / 2);
}

static void print_picture(const struct tl_flight_picture *picture, const char *name, const char *caption,
                          FILE *out)
{
    void *png = NULL;
    size_t size = 0;
    if (tl_image_encode_png(name, &picture->image, &png, &size, NULL))
        tl_report_picture(out, png, size, name, caption);
    free(png);
}

static void print_way(const struct tl_flight *flight, FILE *out)
{
    if (!flight->stop_count)
        return;
    tl_report_heading(out, "The way");
    tl_report_pictures_begin(out);
    for (int i = 0; i < flight->stop_count; i++) {
        int frame = flight->stops[i].frame;
        char name[40], caption[80];
        snprintf(name, sizeof name, "%.1f s", frame / flight->frame_rate);
        snprintf(caption, sizeof caption, "frame %d, %.1f ms", frame, flight->frames[frame].total_ms);
        print_picture(&flight->stops[i], name, caption, out);
    }
    tl_report_pictures_end(out);
}

/* -- frame by frame -- */

/* The largest time of the plots, from frames after the warm-up: the first frames create all resources and
 * would dominate the scale. */
static double highest_shown(const struct tl_flight_account *account)
{
    const double room = 1.25;
    if (!account->figures.judged)
        return INFINITY;
    return room * fmax(account->figures.worst_ms, account->flight->budget_ms);
}

static void print_strip(const struct tl_flight_account *account, FILE *out)
{
    const struct tl_flight *flight = account->flight;
    double highest_ms = highest_shown(account), first_ms = flight->frames[0].total_ms;
    char name[40], caption[240];
    struct flight_lines lines = make_lines(flight);
    struct tl_plot_point *frame = add_line(&lines, flight, "frame");
    struct tl_plot_point *cloth = add_line(&lines, flight, "cloth");
    for (int i = 0; i < flight->count; i++) {
        frame[i].y = fmin(flight->frames[i].total_ms, highest_ms);
        cloth[i].y = flight->frames[i].cloth_ms;
    }
    snprintf(name, sizeof name, "budget %g ms", flight->budget_ms);
    const struct tl_plot_guide budget = {flight->budget_ms, name};
    struct tl_plot_options options = time_options(flight);
    options.guides = &budget;
    options.guide_count = flight->budget_ms > 0;
    snprintf(caption, sizeof caption,
             "Wall time from the choice of levels to the finished image. Shaded: warm-up, which is not "
             "judged%s.",
             first_ms > highest_ms ? "; longer times are cut off" : "");
    tl_report_heading(out, "Every frame");
    print_lines(&lines, "ms", &options, caption, out);
}

/* Histogram of the times after the warm-up. The last bar counts all outliers. */
static void print_histogram(const struct tl_flight_account *account, FILE *out)
{
    enum { BARS = 40 };
    const struct tl_flight *flight = account->flight;
    double high = fmax(1.15 * account->figures.p95_ms, 1.2 * flight->budget_ms), width = high / BARS;
    struct tl_plot_point points[BARS];
    char names[BARS][60], caption[160];
    int beyond = 0;
    if (!(high > 0))
        return;
    for (int i = 0; i < BARS; i++)
        points[i] = (struct tl_plot_point){.x = (i + 0.5) * width, .name = names[i]};
    for (int i = flight->warm_up; i < flight->count; i++) {
        int bar = (int)(flight->frames[i].total_ms / width);
        beyond += bar >= BARS;
        points[bar < BARS ? bar : BARS - 1].y++;
    }
    for (int i = 0; i < BARS; i++)
        snprintf(names[i], sizeof names[i], "%.4g to %.4g ms: %.0f frames", i * width, (i + 1) * width,
                 points[i].y);
    snprintf(caption, sizeof caption, "The number of frames by their time%s.",
             beyond ? "; the last bar includes all longer frames" : "");
    const struct tl_plot_series series = {.name = "frames", .points = points, .count = BARS};
    tl_report_plot_with(
        out, &(struct tl_plot){.x_label = "ms", .y_label = "frames", .series = &series, .series_count = 1},
        &(struct tl_plot_options){
            .kind = TL_PLOT_BARS, .bar_width = width, .height = 260, .y_is_count = true},
        caption);
}

struct ranked {
    int job;
    double total_ms;
};

static int compare_ranked(const void *a, const void *b)
{
    double first = ((const struct ranked *)a)->total_ms, second = ((const struct ranked *)b)->total_ms;
    return (second > first) - (second < first);
}

/* Ranks the jobs by total time, longest first; returns the number of jobs that ran. */
static int rank_jobs(const struct tl_flight *flight, struct ranked ranked[TL_JOBS_MAX])
{
    int count = 0;
    for (int i = 0; i < flight->job_count; i++) {
        struct tl_flight_job job = tl_flight_measure_job(flight, i);
        if (job.ran)
            ranked[count++] = (struct ranked){i, job.total_ms};
    }
    qsort(ranked, (size_t)count, sizeof *ranked, compare_ranked);
    return count;
}

/* Stacked: the cloth at the bottom, the longest jobs above it, the remainder on top. */
static void print_stack(const struct tl_flight_account *account, FILE *out)
{
    const struct tl_flight *flight = account->flight;
    double highest_ms = highest_shown(account);
    struct ranked ranked[TL_JOBS_MAX] = {{0}};
    int count = rank_jobs(flight, ranked), shown = count < JOBS_SHOWN ? count : JOBS_SHOWN;
    struct flight_lines lines = make_lines(flight);
    struct tl_plot_point *layers[TL_PLOT_STYLES];
    layers[0] = add_line(&lines, flight, "cloth");
    for (int k = 0; k < shown; k++)
        layers[1 + k] = add_line(&lines, flight, flight->job_names[ranked[k].job]);
    layers[1 + shown] = add_line(&lines, flight, "all else");
    for (int i = 0; i < flight->count; i++) {
        const struct tl_flight_frame *frame = &flight->frames[i];
        double height = frame->cloth_ms;
        layers[0][i].y = fmin(height, highest_ms);
        for (int k = 0; k < shown; k++) {
            height += frame->job_ms[ranked[k].job];
            layers[1 + k][i].y = fmin(height, highest_ms);
        }
        layers[1 + shown][i].y = fmin(fmax(height, frame->total_ms), highest_ms);
    }
    struct tl_plot_options options = time_options(flight);
    options.kind = TL_PLOT_AREAS;
    tl_report_heading(out, "What it went to");
    print_lines(&lines, "ms", &options, "The times of the jobs, stacked: `toile plan` says what each does.",
                out);
}

static void print_job_table(const struct tl_flight *flight, FILE *out)
{
    struct ranked ranked[TL_JOBS_MAX] = {{0}};
    struct tl_cells cells = {0};
    int count = rank_jobs(flight, ranked), judged = flight->count - flight->warm_up;
    static const char *const heads[] = {"job", "median ms when it ran", "ran in", "of all time"};
    double all_ms = 0;
    for (int i = flight->warm_up; i < flight->count; i++)
        all_ms += flight->frames[i].total_ms;
    for (size_t i = 0; i < TL_COUNT(heads); i++)
        tl_cells_add(&cells, "%s", heads[i]);
    for (int i = 0; i < count; i++) {
        struct tl_flight_job job = tl_flight_measure_job(flight, ranked[i].job);
        tl_cells_add(&cells, "%s", flight->job_names[ranked[i].job]);
        tl_cells_add(&cells, "%.2f", job.median_ms);
        tl_cells_add(&cells, "%.0f %% of frames", 100.0 * job.ran / judged);
        tl_cells_add(&cells, "%.1f %%", 100 * job.total_ms / all_ms);
    }
    tl_cells_print(&cells, TL_COUNT(heads), out);
}

static int highest_level(const struct tl_flight *flight, int control)
{
    int highest = 0;
    for (int i = 0; i < flight->count; i++)
        if (flight->frames[i].levels.of[control] > highest)
            highest = flight->frames[i].levels.of[control];
    return highest;
}

/* One lane for each control that changed, the first on top. */
static void print_levels(const struct tl_flight *flight, FILE *out)
{
    const double lane_height = 46, used = 0.72; /* of a lane, for its levels */
    struct flight_lines lines = make_lines(flight);
    struct tl_plot_guide lanes[TL_CONTROL_COUNT];
    char names[TL_CONTROL_COUNT][40];
    size_t count = 0;
    for (int control = 0; control < TL_CONTROL_COUNT; control++)
        count += highest_level(flight, control) > 0;
    double base = (double)count;
    for (int control = 0; control < TL_CONTROL_COUNT; control++) {
        int highest = highest_level(flight, control);
        if (!highest)
            continue;
        base--;
        lanes[lines.series_count] = (struct tl_plot_guide){base, ""};
        snprintf(names[lines.series_count], sizeof *names, "%s, up to %d", tl_control_names[control],
                 highest);
        struct tl_plot_point *points = add_line(&lines, flight, names[lines.series_count]);
        for (int i = 0; i < flight->count; i++)
            points[i].y = base + used * flight->frames[i].levels.of[control] / highest;
    }
    tl_report_heading(out, "Quality that was reduced to keep the budget");
    if (!count) {
        tl_report_paragraph(out, "Nothing: every frame was drawn as the settings ask for.");
        free(lines.points);
        return;
    }
    struct tl_plot_options options = time_options(flight);
    options.kind = TL_PLOT_STEPS;
    options.y_unlabelled = true;
    options.guides = lanes;
    options.guide_count = count;
    options.height = 66 + lane_height * (double)count;
    print_lines(
        &lines, "levels", &options,
        "A control on its line has the quality of the settings; the distance above the line is the number of "
        "levels by which it is reduced. Controls that are not shown were never reduced.",
        out);
}

static void print_predictions(const struct tl_flight_account *account, FILE *out)
{
    const struct tl_flight *flight = account->flight;
    struct tl_plot_point *points = TL_NEW_ARRAY(struct tl_plot_point, (size_t)flight->count);
    char(*names)[24] = tl_alloc((size_t)flight->count, sizeof *names);
    char caption[200];
    double high = 0;
    size_t count = 0;
    for (int i = flight->warm_up; i < flight->count; i++) {
        const struct tl_flight_frame *frame = &flight->frames[i];
        if (!isfinite(frame->predicted_ms))
            continue;
        snprintf(names[count], sizeof *names, "frame %d", i);
        high = fmax(high, fmax(frame->predicted_ms, frame->total_ms));
        points[count] = (struct tl_plot_point){frame->predicted_ms, frame->total_ms, names[count], false};
        count++;
    }
    const struct tl_plot_point diagonal[] = {{0, 0, "", false}, {high, high, "", false}};
    const struct tl_plot_series series[] = {
        {.name = "frames", .points = points, .count = count},
        {.name = "as predicted", .points = diagonal, .count = 2, .front = true}};
    snprintf(
        caption, sizeof caption,
        "Half of all frames were predicted within %.1f %%. Frames above the line took longer than predicted.",
        100 * account->figures.prediction_error);
    if (count) {
        tl_report_heading(out, "Predicted and measured");
        tl_report_plot_with(
            out,
            &(struct tl_plot){
                .x_label = "predicted, ms", .y_label = "measured, ms", .series = series, .series_count = 2},
            &(struct tl_plot_options){.height = 400}, caption);
    }
    free(names);
    free(points);
}

/* The part of a frame whose time exceeds its own median most. */
static void explain(const struct tl_flight_account *account, int number, char *out, size_t size)
{
    const struct tl_flight *flight = account->flight;
    const struct tl_flight_frame *frame = &flight->frames[number];
    const char *culprit = "cloth";
    double took_ms = frame->cloth_ms, usual_ms = account->figures.cloth_ms, jobs_ms = 0;
    for (int i = 0; i < flight->job_count; i++) {
        double ms = frame->job_ms[i], median_ms = tl_flight_measure_job(flight, i).median_ms;
        jobs_ms += ms;
        if (ms > 0 && ms - median_ms > took_ms - usual_ms) {
            culprit = flight->job_names[i];
            took_ms = ms;
            usual_ms = median_ms;
        }
    }
    double rest_ms = frame->total_ms - frame->cloth_ms - jobs_ms;
    if (rest_ms > took_ms - usual_ms)
        snprintf(out, size, "%.1f ms. Outside of all jobs: %.1f ms", frame->total_ms, rest_ms);
    else
        snprintf(out, size, "%.1f ms. Most above its median: %s, %.1f instead of %.1f ms", frame->total_ms,
                 culprit, took_ms, usual_ms);
}

static void print_worst(const struct tl_flight_account *account, FILE *out)
{
    const struct tl_flight *flight = account->flight;
    if (!flight->worst_count)
        return;
    tl_report_heading(out, "The longest frames");
    tl_report_pictures_begin(out);
    for (int i = 0; i < flight->worst_count; i++) {
        char name[40], caption[160];
        snprintf(name, sizeof name, "frame %d", flight->worst[i].frame);
        explain(account, flight->worst[i].frame, caption, sizeof caption);
        print_picture(&flight->worst[i], name, caption, out);
    }
    tl_report_pictures_end(out);
}

/* The main figure first. */
static const struct {
    const char *name;
    size_t offset;
} oracle_lines[] = {
    {"FLIP of the garment", offsetof(struct tl_flight_frame, garment_flip)},
    {"of its worst 5 %", offsetof(struct tl_flight_frame, garment_flip_worst)},
    {"FLIP of all covered pixels", offsetof(struct tl_flight_frame, flip_mean)},
    {"relative RMSE of all covered pixels", offsetof(struct tl_flight_frame, rel_rmse)},
    {"estimated error of the levels", offsetof(struct tl_flight_frame, error)},
};

static void print_oracle(const struct tl_flight_account *account, FILE *out)
{
    const struct tl_flight *flight = account->flight;
    const struct tl_flight_figures *figures = &account->figures;
    char text[600], garment[200] = "None of them shows the garment. ";
    if (!figures->oracle_frames)
        return;
    struct flight_lines lines = make_lines(flight);
    for (size_t k = 0; k < TL_COUNT(oracle_lines); k++) {
        struct tl_plot_point *points = add_line(&lines, flight, oracle_lines[k].name);
        int count = 0;
        for (int i = 0; i < flight->count; i++) {
            double value;
            memcpy(&value, (const char *)&flight->frames[i] + oracle_lines[k].offset, sizeof value);
            if (isfinite(value))
                points[count++] =
                    (struct tl_plot_point){i / flight->frame_rate, value, oracle_lines[k].name, false};
        }
        lines.series[k].count = (size_t)count;
    }
    struct tl_plot_options options = time_options(flight);
    tl_report_heading(out, "Error against the reference");
    if (figures->garment_frames)
        snprintf(garment, sizeof garment,
                 "FLIP of the garment, as shown: mean %.4f (largest of a frame %.4f), of its worst 5 %% of "
                 "pixels %.4f. ",
                 figures->garment_flip, figures->garment_flip_max, figures->garment_flip_worst);
    snprintf(text, sizeof text,
             "%d frames against the ray-traced reference. %sOver all covered pixels, of which most may be "
             "the ground: mean FLIP %.4f (largest %.4f), relative RMSE %.2f %%.",
             figures->oracle_frames, garment, figures->flip_mean, figures->flip_max, 100 * figures->rel_rmse);
    print_lines(&lines, "error", &options, text, out);
}

static void print_against(const struct tl_flight_account *account, FILE *out)
{
    static const char *const heads[] = {"", "this, ms", "that, ms", "ratio", "95 % interval", ""};
    static const char *const words[] = {"", "faster", "slower", "unclear"};
    struct tl_cells cells = {0};
    char text[400];
    if (!account->against)
        return;
    tl_report_heading(out, "Against an earlier flight");
    snprintf(text, sizeof text,
             "Medians of this flight over those of %.150s, frame by frame along the same path. The interval "
             "includes the noise within each run, but not a machine that was busier in one of them: where "
             "wall and "
             "CPU time of the frame disagree, no row has a verdict.",
             account->against);
    tl_report_paragraph(out, text);
    for (size_t i = 0; i < TL_COUNT(heads); i++)
        tl_cells_add(&cells, "%s", heads[i]);
    for (int i = 0; i < account->ratio_count; i++) {
        const struct tl_flight_ratio *ratio = &account->ratios[i];
        tl_cells_add(&cells, "%s", ratio->name);
        tl_cells_add(&cells, "%.2f", ratio->this_ms);
        tl_cells_add(&cells, "%.2f", ratio->that_ms);
        tl_cells_add(&cells, "%.3f", ratio->ratio);
        tl_cells_add(&cells, "%.3f to %.3f", ratio->low, ratio->high);
        tl_cells_add(&cells, "%s", words[ratio->verdict]);
    }
    tl_cells_print(&cells, TL_COUNT(heads), out);
}

static void print_replay(const struct tl_flight_account *account, FILE *out)
{
    char text[400];
    if (!account->replay)
        return;
    snprintf(text, sizeof text, "A replay of the levels of %.150s: %d of %d images are the same to the bit.",
             account->replay, account->compared - account->different, account->compared);
    tl_report_paragraph(out, text);
}

static void print_settings(const struct tl_settings *settings, FILE *out)
{
    struct tl_settings copy = *settings;
    struct tl_binding bindings[TL_SETTINGS_TABLES];
    struct tl_cells cells = {0};
    tl_settings_bind(&copy, bindings);
    tl_cells_add(&cells, "option");
    tl_cells_add(&cells, "value");
    for (size_t t = 0; t < TL_SETTINGS_TABLES; t++)
        for (size_t r = 0; r < bindings[t].table->row_count; r++) {
            const struct tl_option *row = &bindings[t].table->rows[r];
            char *text = tl_options_get_text(&bindings[t], row);
            tl_cells_add(&cells, "%s.%s", bindings[t].table->name, row->name);
            tl_cells_add(&cells, "%s %s", text, row->unit);
            free(text);
        }
    tl_report_fold_begin(out, "The settings as they were read");
    tl_cells_print(&cells, 2, out);
    tl_report_fold_end(out);
}

static void print_head(const struct tl_flight_account *account, FILE *out)
{
    const struct tl_flight *flight = account->flight;
    const struct tl_image_params *image = &account->settings->image;
    char title[200], subtitle[700];
    if (!account->figures.judged)
        snprintf(title, sizeof title, "%d frames, all of them warm-up", flight->count);
    else if (flight->budget_ms > 0)
        snprintf(title, sizeof title, "%.1f %% of %d frames within 1.1 x %g ms",
                 100 * account->figures.within, account->figures.judged, flight->budget_ms);
    else
        snprintf(title, sizeof title, "%d frames, half of them within %.1f ms", flight->count,
                 account->figures.p50_ms);
    snprintf(subtitle, sizeof subtitle,
             "toile fly: scene %.120s, %d x %d pixels, path %.120s, %d frames at %g a second; %.120s, %d "
             "cores%s%.120s",
             account->scene, image->width, image->height, account->path, flight->count, flight->frame_rate,
             account->gl, account->cores, account->stopped ? "; " : "",
             account->stopped ? account->stopped : "");
    tl_report_begin(out, title, subtitle);
}

void tl_flight_write_report(const struct tl_flight_account *account, FILE *out)
{
    const struct tl_flight *flight = account->flight;
    print_head(account, out);
    print_tiles(account, out);
    print_replay(account, out);
    print_strip(account, out);
    print_histogram(account, out);
    print_way(flight, out);
    print_stack(account, out);
    print_job_table(flight, out);
    print_levels(flight, out);
    print_predictions(account, out);
    print_worst(account, out);
    print_oracle(account, out);
    print_against(account, out);
    print_settings(account->settings, out);
    tl_report_end(out);
}
