/* toile bench light: time and error of the presets in motion, measured side by side. */
#include "app/cli/json.h"
#include "app/lab/experiments/experiment.h"
#include "app/lab/experiments/experiments.h"
#include "app/lab/trade/bench.h"
#include "app/measure/measure.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FRAMES_MAX   12 /* measured ones */
#define COMPARED_MAX 3
#define REST_MAX     1024 /* frames at rest */

struct light_schedule {
    int warm;          /* frames of history before the first measured one */
    int measured;      /* at most FRAMES_MAX */
    int compare_every; /* every so many measured frames one is compared with the reference */
};
static const struct light_schedule full = {16, 12, 4}, quick = {2, 2, 2};

#define ROWS_MAX 8

struct light_row {
    const char *name;
    struct tl_variant_run variant;
    double cpu_ms[FRAMES_MAX], wall_ms[FRAMES_MAX];
    struct tl_measured_error error[COMPARED_MAX];
    size_t memory_bytes;
};

/* Draws the last frame until the renderer is at rest, and once more. */
struct rest {
    int frames;
    double cpu_ms, done_cpu_ms; /* of a frame that still averages (median), and of the one after */
    struct tl_measured_error error;
};

struct light_bench {
    struct rest rest; /* of review */
    struct light_schedule schedule;
    struct tl_headless headless;
    tl_recording *recording;
    struct tl_variant_run reference;
    struct light_row rows[ROWS_MAX];
    int row_count;
};

struct row_summary {
    double cpu_ms, wall_ms, rel_rmse, flip_mean;
    double worst_share; /* of a frame's square error: the most that one pixel holds */
};

static int find_index(const struct light_bench *bench, const char *name)
{
    int i = 0;
    while (strcmp(bench->rows[i].name, name) != 0)
        i++;
    return i;
}

static const struct light_row *find_row(const struct light_bench *bench, const char *name)
{
    return &bench->rows[find_index(bench, name)];
}

static int compared_count(const struct light_bench *bench)
{
    return bench->schedule.measured / bench->schedule.compare_every;
}

static struct row_summary summarise(const struct light_bench *bench, const struct light_row *row)
{
    size_t frames = (size_t)bench->schedule.measured;
    struct row_summary summary = {.cpu_ms = tl_median(row->cpu_ms, frames),
                                  .wall_ms = tl_median(row->wall_ms, frames)};
    for (int i = 0, compared = compared_count(bench); i < compared; i++) {
        summary.rel_rmse += row->error[i].rel_rmse / compared;
        summary.flip_mean += row->error[i].flip_mean / compared;
        summary.worst_share = fmax(summary.worst_share, row->error[i].worst_share);
    }
    return summary;
}

static double coverage(const struct light_bench *bench)
{
    const struct tl_image_params *image = &bench->headless.settings.image;
    return (double)find_row(bench, "paper")->error[0].covered / ((double)image->width * image->height);
}

static bool prepare(struct light_bench *bench, const struct tl_arguments *arguments, tl_error *error)
{
    struct tl_headless *headless = &bench->headless;
    if (!tl_headless_create(headless, arguments, error))
        return false;
    bench->recording =
        tl_motion_record(headless->session, bench->schedule.warm + bench->schedule.measured, error);
    if (!bench->recording)
        return false;
    const struct tl_experiment *experiment = tl_experiment_find(TL_OUTPUT_TABLE, "light");
    if (!tl_variant_run_create(&bench->reference, headless->gpu, &experiment->reference, &headless->settings,
                               error))
        return false;
    const struct tl_technique *technique = NULL;
    while ((technique = tl_experiment_next(experiment, TL_OUTPUT_TABLE, technique))) {
        assert(bench->row_count < ROWS_MAX);
        struct light_row *row = &bench->rows[bench->row_count++];
        row->name = technique->table;
        if (!tl_variant_run_create(&row->variant, headless->gpu, &technique->setup, &headless->settings,
                                   error))
            return false;
    }
    return true;
}

static void release(struct light_bench *bench)
{
    for (int i = 0; i < bench->row_count; i++)
        tl_variant_run_release(&bench->rows[i].variant);
    tl_variant_run_release(&bench->reference);
    tl_recording_destroy(&bench->recording);
    tl_headless_release(&bench->headless);
}

/* One frame before the first measured one. A technique without history draws only the last of them, to fill
 * its caches. */
static bool warm_up(struct light_bench *bench, int number, tl_error *error)
{
    struct tl_taken unused;
    tl_frame frame = tl_recording_frame(bench->recording, number);
    for (int i = 0; i < bench->row_count; i++) {
        struct tl_variant_run *variant = &bench->rows[i].variant;
        if ((number == bench->schedule.warm - 1 || tl_variant_run_has_history(variant)) &&
            !tl_variant_run_draw(variant, &frame, &unused, error))
            return false;
    }
    return true;
}

static bool come_to_rest(struct light_bench *bench, const tl_frame *frame,
                         const struct tl_reference_frame *reference, tl_error *error)
{
    struct tl_variant_run *variant = &bench->rows[find_index(bench, "review")].variant;
    struct rest *rest = &bench->rest;
    struct tl_taken taken;
    double cpu_ms[REST_MAX];
    while (rest->frames < REST_MAX && !tl_renderer_is_at_rest(variant->renderer)) {
        if (!tl_variant_run_draw(variant, frame, &taken, error))
            return false;
        cpu_ms[rest->frames++] = taken.cpu_ms;
    }
    rest->cpu_ms = rest->frames ? tl_median(cpu_ms, (size_t)rest->frames) : 0;
    if (!tl_variant_run_draw(variant, frame, &taken, error))
        return false;
    rest->done_cpu_ms = taken.cpu_ms;
    return tl_variant_run_compare(variant, reference, &rest->error, error);
}

static bool compare_all(struct light_bench *bench, const tl_frame *frame, int at, tl_error *error)
{
    struct tl_reference_frame reference = {0};
    bool done = tl_reference_frame_draw(&bench->reference, frame, &reference, error);
    for (int i = 0; done && i < bench->row_count; i++)
        done = tl_variant_run_compare(&bench->rows[i].variant, &reference, &bench->rows[i].error[at], error);
    if (done && at == compared_count(bench) - 1)
        done = come_to_rest(bench, frame, &reference, error);
    tl_reference_frame_release(&reference);
    return done;
}

/* Draws one frame by every technique in turn, so that other load on the machine affects all alike. */
static bool measure(struct light_bench *bench, int number, tl_error *error)
{
    int at = number - bench->schedule.warm, every = bench->schedule.compare_every;
    tl_frame frame = tl_recording_frame(bench->recording, number);
    for (int i = 0; i < bench->row_count; i++) {
        struct tl_taken taken;
        struct light_row *row = &bench->rows[i];
        if (!tl_variant_run_draw(&row->variant, &frame, &taken, error))
            return false;
        row->cpu_ms[at] = taken.cpu_ms;
        row->wall_ms[at] = taken.wall_ms;
        row->memory_bytes = tl_renderer_memory(row->variant.renderer).total;
    }
    return at % every != every - 1 || compare_all(bench, &frame, at / every, error);
}

static bool run(struct light_bench *bench, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("measuring light");
    int frames = bench->schedule.warm + bench->schedule.measured;
    bool done = true;
    for (int number = 0; done && number < frames; number++) {
        done = number < bench->schedule.warm ? warm_up(bench, number, error) : measure(bench, number, error);
        if (done && tl_interrupted())
            done = tl_fail(error, TL_INTERRUPTED, "bench: stopped at frame %d of %d", number, frames);
        tl_progress_update(&progress, number + 1, frames);
    }
    tl_progress_end(&progress);
    return done;
}

static void print_table(const struct light_bench *bench)
{
    struct tl_recording_report recording = tl_recording_report(bench->recording);
    const struct tl_image_params *image = &bench->headless.settings.image;
    printf(
        "%d x %d pixels, %.1f %% covered, %zu garment triangles, moving %.1f mm a frame on average;\n"
        "medians of %d frames, process CPU time; errors are means of %d frames against the reference, whose "
        "standard error of %.2f %% is taken off; one pixel: the most of a frame's square error that its "
        "worst "
        "pixel holds, as where an outline's tie puts a highlight in or out\n\n",
        image->width, image->height, 100 * coverage(bench), recording.garment_triangles,
        1e3 * recording.mean_step_m, bench->schedule.measured, compared_count(bench),
        100 * find_row(bench, "paper")->error[0].standard_error);
    printf("%-24s %10s %10s %10s %10s %10s %10s\n", "", "CPU ms", "wall ms", "rel. RMSE", "one pixel",
           "mean FLIP", "MiB");
    for (int i = 0; i < bench->row_count; i++) {
        struct row_summary row = summarise(bench, &bench->rows[i]);
        printf("%-24s %10.1f %10.1f %9.2f%% %9.0f%% %10.4f %10.1f\n", bench->rows[i].name, row.cpu_ms,
               row.wall_ms, 100 * row.rel_rmse, 100 * row.worst_share, row.flip_mean,
               (double)bench->rows[i].memory_bytes / (1 << 20));
    }
    printf("%-24s %10.1f\n\n", "(the cloth's solver)", recording.cloth_cpu_ms);
    const struct rest *rest = &bench->rest;
    printf("review at rest: %.1f ms of CPU a frame for %d frames, then %.1f; rel. RMSE %.2f %% (one pixel "
           "holds %.0f %% of its square), mean FLIP %.4f\n",
           rest->cpu_ms, rest->frames, rest->done_cpu_ms, 100 * rest->error.rel_rmse,
           100 * rest->error.worst_share, rest->error.flip_mean);
    struct row_summary paper = summarise(bench, find_row(bench, "paper")),
                       review = summarise(bench, find_row(bench, "review"));
    printf("paper takes %.1f times review's time; review has %.2f of paper's error (FLIP %.2f)\n",
           paper.cpu_ms / review.cpu_ms, review.rel_rmse / paper.rel_rmse,
           review.flip_mean / paper.flip_mean);
}

static void print_json(const struct light_bench *bench)
{
    struct tl_recording_report recording = tl_recording_report(bench->recording);
    struct row_summary paper = summarise(bench, find_row(bench, "paper")),
                       review = summarise(bench, find_row(bench, "review"));
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "time_ratio", paper.cpu_ms / review.cpu_ms);
    cJSON_AddNumberToObject(object, "error_ratio", review.rel_rmse / paper.rel_rmse);
    cJSON_AddNumberToObject(object, "flip_ratio", review.flip_mean / paper.flip_mean);
    cJSON_AddNumberToObject(object, "coverage", coverage(bench));
    cJSON_AddNumberToObject(object, "garment_triangles", (double)recording.garment_triangles);
    cJSON_AddNumberToObject(object, "mean_step_m", recording.mean_step_m);
    cJSON_AddNumberToObject(object, "cloth_cpu_ms", recording.cloth_cpu_ms);
    cJSON_AddNumberToObject(object, "standard_error", find_row(bench, "paper")->error[0].standard_error);
    cJSON *rest = cJSON_AddObjectToObject(object, "review_at_rest");
    cJSON_AddNumberToObject(rest, "frames", bench->rest.frames);
    cJSON_AddNumberToObject(rest, "cpu_ms", bench->rest.cpu_ms);
    cJSON_AddNumberToObject(rest, "cpu_ms_done", bench->rest.done_cpu_ms);
    cJSON_AddNumberToObject(rest, "rel_rmse", bench->rest.error.rel_rmse);
    cJSON_AddNumberToObject(rest, "flip_mean", bench->rest.error.flip_mean);
    cJSON *rows = cJSON_AddArrayToObject(object, "rows");
    for (int i = 0; i < bench->row_count; i++) {
        struct row_summary summary = summarise(bench, &bench->rows[i]);
        cJSON *row = cJSON_CreateObject();
        cJSON_AddStringToObject(row, "name", bench->rows[i].name);
        cJSON_AddNumberToObject(row, "cpu_ms", summary.cpu_ms);
        cJSON_AddNumberToObject(row, "wall_ms", summary.wall_ms);
        cJSON_AddNumberToObject(row, "rel_rmse", summary.rel_rmse);
        cJSON_AddNumberToObject(row, "worst_share", summary.worst_share);
        cJSON_AddNumberToObject(row, "flip_mean", summary.flip_mean);
        cJSON_AddNumberToObject(row, "memory_bytes", (double)bench->rows[i].memory_bytes);
        cJSON_AddItemToArray(rows, row);
    }
    tl_json_print(object);
}

bool tl_bench_light(const struct tl_arguments *arguments, tl_error *error)
{
    struct light_bench *bench = TL_NEW(struct light_bench);
    bench->schedule = arguments->quick ? quick : full;
    bool done = prepare(bench, arguments, error) && run(bench, error);
    if (done && arguments->json)
        print_json(bench);
    else if (done)
        print_table(bench);
    release(bench);
    free(bench);
    return done;
}
