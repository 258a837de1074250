/* The extremes of light, drawn by two methods and compared with the ray-traced reference. */
#include "app/cli/json.h"
#include "app/cli/topic.h"
#include "app/lab/experiments/experiment.h"
#include "app/lab/experiments/experiments.h"
#include "app/settings/command.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/metrics/compare.h"
#include "tests/app/stability/extremes_light.h"
#include "tests/app/stability/stability.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIDE       48 /* pixels of the images */
#define EXACT_RMSE 0.001
/* A reference with a larger standard error measures nothing. */
#define NOISE_MAX 0.05

/* Errors in stops are those of one pixel's light: the absolute log2 of what is shown over what is right. Ten
 * stops below the mean of what is right all is black: this much is added to both. The mean is the cell's. */
#define STOPS_BLACK 10

struct light_error {
    struct tl_cell_error measured; /* relative RMSE; stops, mean of the covered pixels */
    double stops_95;               /* 19 of 20 pixels are within this */
};

struct light_cell {
    enum tl_outcome outcome;
    struct light_error error; /* NaN when there is no image */
    double bound, remedied;   /* relative RMSE; NaN when there is none */
    tl_error message;         /* why there is no figure */
};

struct light_suite {
    struct tl_settings settings;
    tl_gpu *gpu;
    struct tl_variant_run methods[TL_EXTREME_METHODS], unshadowed, reference;
    struct light_cell *cells; /* [tl_extreme_count][TL_EXTREME_METHODS] */
};

static const char *const method_names[TL_EXTREME_METHODS] = {
    [TL_EXTREME_PAPER] = "paper", [TL_EXTREME_REVIEW] = "review"};

static const struct tl_technique *find_technique(const struct tl_experiment *experiment, const char *name)
{
    const struct tl_technique *technique = NULL;
    while ((technique = tl_experiment_next(experiment, TL_OUTPUT_BOUNDS, technique)))
        if (strcmp(technique->bound, name) == 0)
            break;
    return technique;
}

static bool prepare(struct light_suite *suite, const struct tl_arguments *arguments, tl_error *error)
{
    const struct tl_experiment *experiment = tl_experiment_find(TL_OUTPUT_BOUNDS, "light");
    if (!tl_settings_of_command(arguments, false, &suite->settings, error))
        return false;
    suite->settings.image.width = suite->settings.image.height = SIDE;
    suite->settings.image.supersample = 1;
    suite->cells = TL_NEW_ARRAY(struct light_cell, tl_extreme_count * TL_EXTREME_METHODS);
    suite->gpu = tl_gpu_create_headless(error);
    if (!suite->gpu || !tl_variant_run_create(&suite->reference, suite->gpu, &experiment->reference,
                                              &suite->settings, error))
        return false;
    if (!tl_variant_run_create(&suite->unshadowed, suite->gpu,
                               &find_technique(experiment, "unshadowed")->setup, &suite->settings, error))
        return false;
    for (int m = 0; m < TL_EXTREME_METHODS; m++)
        if (!tl_variant_run_create(&suite->methods[m], suite->gpu,
                                   &find_technique(experiment, method_names[m])->setup, &suite->settings,
                                   error))
            return false;
    return true;
}

static void release(struct light_suite *suite)
{
    for (int m = 0; m < TL_EXTREME_METHODS; m++)
        tl_variant_run_release(&suite->methods[m]);
    tl_variant_run_release(&suite->unshadowed);
    tl_variant_run_release(&suite->reference);
    tl_gpu_destroy(&suite->gpu);
    free(suite->cells);
}

static bool has_nan(const tl_image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(tl_image_floats(image)[i]))
            return true;
    return false;
}

static bool covers(const tl_image *image)
{
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        if (tl_image_floats(image)[4 * i + 3] > 0)
            return true;
    return false;
}

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double light_of(const tl_image *image, size_t pixel)
{
    const float *texel = tl_image_floats(image) + 4 * pixel;
    return ((double)texel[0] + (double)texel[1] + (double)texel[2]) / 3;
}

static void measure_stops(const tl_image *tested, const tl_image *reference, struct light_error *out)
{
    size_t count = (size_t)reference->width * (size_t)reference->height, covered = 0;
    double *stops = TL_NEW_ARRAY(double, count), mean = 0, sum = 0;
    for (size_t i = 0; i < count; i++)
        mean += light_of(reference, i) / (double)count;
    double black = ldexp(mean, -STOPS_BLACK);
    for (size_t i = 0; i < count; i++) {
        double shown = light_of(tested, i) + black, right = light_of(reference, i) + black;
        if (tl_image_floats(tested)[4 * i + 3] > 0 || tl_image_floats(reference)[4 * i + 3] > 0)
            sum += stops[covered++] = shown == right ? 0 : fabs(log2(shown / right));
    }
    qsort(stops, covered, sizeof *stops, compare_numbers);
    out->measured.own = sum / (double)covered;
    out->stops_95 = stops[covered * 95 / 100];
    free(stops);
}

/* The exact image and its own standard error, relative like an RMSE. */
struct truth {
    tl_image image;
    double standard_error;
};

/* 0 when neither image shows anything. Without the truth's own noise, which is independent of the error. */
static bool measure_error(const tl_image *tested, const struct truth *truth, struct light_error *out,
                          tl_error *error)
{
    const tl_image *reference = &truth->image;
    struct tl_comparison comparison;
    *out = (struct light_error){.measured.unit = "stops"};
    if (!covers(tested) && !covers(reference))
        return true;
    const int ldr = 0; /* no FLIP: an image that is half black has no exposure */
    bool done = tl_image_compare(tested, reference, ldr, 0, &comparison, error);
    if (done)
        measure_stops(tested, reference, out);
    double noise = truth->standard_error;
    out->measured.share =
        done ? sqrt(fmax(comparison.rel_rmse * comparison.rel_rmse - noise * noise, 0)) : NAN;
    return done;
}

/* Sets "light.key=value reference.key=value". */
static bool assign(struct tl_render_settings *settings, const char *assignments, tl_error *error)
{
    struct tl_binding bindings[TL_RENDER_TABLES];
    tl_render_settings_bind(settings, bindings);
    char *list = tl_format("%s", assignments ? assignments : ""), *rest = list, *one;
    bool done = true;
    while (done && (one = strsep(&rest, " ")))
        done = !*one || tl_options_set_assignment(bindings, TL_RENDER_TABLES, one, error);
    free(list);
    return done;
}

/* `remedy`: assignments over the extreme's; NULL: none. */
static bool picture(struct tl_variant_run *variant, const struct tl_extreme *extreme, const char *remedy,
                    struct tl_extreme_scene *scene, tl_image *out, tl_error *error)
{
    struct tl_taken unused;
    tl_frame frame = tl_extreme_frame(scene);
    frame.still = true; /* else rays of one round, whose noise depends on how many frames were drawn before */
    struct tl_variant_run changed = *variant;
    changed.settings.image.ground = scene->ground;
    /* Its surfaces reflect more light than they receive, as no cloth does: what that does to light that
     * bounces has extremes of its own, and would hide what all others are about. */
    changed.settings.light.bounce = TL_BOUNCE_OFF;
    return assign(&changed.settings, extreme->assignments, error) &&
           assign(&changed.settings, remedy, error) &&
           tl_variant_run_draw(&changed, &frame, &unused, error) &&
           tl_renderer_read(variant->renderer, out, error);
}

static struct light_cell judge(const struct tl_extreme *extreme, const tl_image *image,
                               const struct truth *truth, double bound)
{
    struct light_cell cell = {
        .outcome = TL_OUTCOME_SILENT, .error = {TL_CELL_NO_ERROR, NAN}, .bound = bound, .remedied = NAN};
    if (has_nan(image) || (!extreme->refused && has_nan(&truth->image)))
        cell.outcome = TL_OUTCOME_NAN;
    else if (extreme->refused)
        tl_fail(&cell.message, TL_UNSTABLE, "drawn, though %s", extreme->why);
    else if (truth->standard_error > NOISE_MAX)
        tl_fail(&cell.message, TL_UNSTABLE, "not measured: the reference is uncertain by %.1f %%",
                100 * truth->standard_error);
    else if (measure_error(image, truth, &cell.error, &cell.message))
        cell.outcome = tl_outcome_of(cell.error.measured.share, EXACT_RMSE, bound);
    return cell;
}

/* A refusal counts if it was expected and its message is not empty. */
static struct light_cell refuse(const struct tl_extreme *extreme, const tl_error *error)
{
    bool clear =
        extreme->refused && error->message[0] && (error->code == TL_USAGE || error->code == TL_INPUT);
    struct light_cell cell = {.outcome = clear ? TL_OUTCOME_REFUSED : TL_OUTCOME_SILENT,
                              .error = {TL_CELL_NO_ERROR, NAN},
                              .bound = NAN,
                              .remedied = NAN,
                              .message = *error};
    return cell;
}

/* The bound of one method; NaN, which nothing keeps, when there is nothing to compare with. */
static double bound_of(struct light_suite *suite, const struct tl_extreme *extreme, int method,
                       struct tl_extreme_scene *scene, const struct truth *truth)
{
    if (extreme->bounds[method] != TL_NO_WORSE)
        return extreme->bounds[method];
    tl_image image = {0};
    struct light_error found = {.measured.share = NAN};
    tl_error error;
    if (picture(&suite->unshadowed, extreme, NULL, scene, &image, &error))
        measure_error(&image, truth, &found, &error);
    tl_image_release(&image);
    return found.measured.share;
}

/* A coarse cell stays coarse if its remedy keeps the stated share; else the program has none to offer. */
static void remedy(struct light_suite *suite, const struct tl_extreme *extreme, int method,
                   struct tl_extreme_scene *scene, const struct truth *truth, struct light_cell *cell)
{
    const char *assignments = extreme->remedies[method];
    struct light_error found = {.measured.share = NAN};
    tl_image image = {0};
    if (!assignments)
        tl_fail(&cell->message, TL_UNSTABLE, "above %.0f %%, and no remedy is stated", 100 * TL_STATED_SHARE);
    else if (picture(&suite->methods[method], extreme, assignments, scene, &image, &cell->message) &&
             measure_error(&image, truth, &found, &cell->message) &&
             !(found.measured.share <= TL_STATED_SHARE))
        tl_fail(&cell->message, TL_UNSTABLE, "the remedy %s leaves %.1f %%", assignments,
                100 * found.measured.share);
    cell->remedied = found.measured.share;
    if (cell->message.message[0])
        cell->outcome = TL_OUTCOME_SILENT;
    tl_image_release(&image);
}

static void run_extreme(struct light_suite *suite, size_t index)
{
    const struct tl_extreme *extreme = &tl_extremes[index];
    struct tl_extreme_scene scene;
    tl_error error = {0};
    struct truth truth = {0};
    bool made = tl_extreme_scene_make(extreme, &scene, &error) &&
                (extreme->refused || picture(&suite->reference, extreme, NULL, &scene, &truth.image, &error));
    if (made && !extreme->refused && covers(&truth.image))
        truth.standard_error = tl_renderer_standard_error(suite->reference.renderer);
    for (int m = 0; m < TL_EXTREME_METHODS; m++) {
        tl_image image = {0};
        struct light_cell *cell = &suite->cells[index * TL_EXTREME_METHODS + (size_t)m];
        if (made && picture(&suite->methods[m], extreme, NULL, &scene, &image, &error))
            *cell = judge(extreme, &image, &truth,
                          extreme->refused ? NAN : bound_of(suite, extreme, m, &scene, &truth));
        else
            *cell = refuse(extreme, &error);
        if (cell->outcome == TL_OUTCOME_COARSE)
            remedy(suite, extreme, m, &scene, &truth, cell);
        tl_image_release(&image);
    }
    tl_image_release(&truth.image);
    tl_extreme_scene_release(&scene);
}

static bool run(struct light_suite *suite, bool quick, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("drawing extremes");
    bool done = true;
    for (size_t i = 0; done && i < tl_extreme_count; i++) {
        if (!(quick && tl_extremes[i].slow))
            run_extreme(suite, i);
        if (tl_interrupted())
            done = tl_fail(error, TL_INTERRUPTED, "stability: stopped at extreme %zu of %zu", i,
                           tl_extreme_count);
        tl_progress_update(&progress, (double)i + 1, (double)tl_extreme_count);
    }
    tl_progress_end(&progress);
    return done;
}

static const char *reason_of(const struct light_cell *cell, size_t extreme)
{
    return cell->message.message[0] ? cell->message.message : tl_extremes[extreme].why;
}

static void add_cells(const struct light_suite *suite, bool quick, struct tl_stability *out)
{
    for (size_t i = 0; i < tl_extreme_count; i++)
        for (int m = 0; m < TL_EXTREME_METHODS && !(quick && tl_extremes[i].slow); m++) {
            const struct light_cell *cell = &suite->cells[i * TL_EXTREME_METHODS + (size_t)m];
            cJSON *row = tl_stability_add(out, "light", cell->outcome, &cell->error.measured);
            cJSON_AddStringToObject(row, "extreme", tl_extremes[i].name);
            cJSON_AddStringToObject(row, "method", method_names[m]);
            tl_json_add_number(row, "stops_95", cell->error.stops_95);
            tl_json_add_number(row, "bound_percent", 100 * cell->bound);
            cJSON_AddStringToObject(row, "why", reason_of(cell, i));
            if (cell->outcome == TL_OUTCOME_COARSE) {
                cJSON_AddStringToObject(row, "remedy", tl_extremes[i].remedies[m]);
                cJSON_AddNumberToObject(row, "remedied_percent", 100 * cell->remedied);
            }
        }
}

bool tl_stability_light(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error)
{
    struct light_suite suite = {0};
    struct tl_arguments scene = *arguments;
    tl_topic_default_scene(&scene, "review");
    bool done = prepare(&suite, &scene, error) && run(&suite, arguments->quick, error);
    if (done)
        add_cells(&suite, arguments->quick, out);
    release(&suite);
    return done;
}
