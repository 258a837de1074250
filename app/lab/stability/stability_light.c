/* The extremes of light, drawn by two methods and compared with the ray-traced reference. */
#include "app/cli/topic.h"
#include "app/lab/experiments/experiment.h"
#include "app/lab/experiments/experiments.h"
#include "app/lab/stability/extremes_light.h"
#include "app/lab/stability/stability.h"
#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"
#include "render/metrics/compare.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE         64 /* pixels of the images */
#define QUICK_STRIDE 6
/* The noise of the reference lies below it. */
#define EXACT_RMSE 0.001

struct light_cell {
    enum tl_outcome outcome;
    double rel_rmse, bound; /* NaN when there is no image */
    tl_error error;         /* why there is no figure */
};

struct light_suite {
    struct tl_settings settings;
    tl_gpu *gpu;
    struct tl_variant_run methods[TL_EXTREME_METHODS], unshadowed, reference;
    size_t stride;            /* from one drawn extreme to the next */
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
    if (!tl_headless_settings(arguments, &suite->settings, error))
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

/* 0 when neither image shows anything. */
static bool relative_error(const tl_image *tested, const tl_image *reference, double *out, tl_error *error)
{
    struct tl_comparison comparison;
    *out = 0;
    if (!covers(tested) && !covers(reference))
        return true;
    const int ldr = 0; /* no FLIP: an image that is half black has no exposure */
    bool done = tl_image_compare(tested, reference, ldr, 0, &comparison, error);
    *out = comparison.rel_rmse;
    return done;
}

static bool picture(struct tl_variant_run *variant, const struct tl_extreme *extreme,
                    struct tl_extreme_scene *scene, tl_image *out, tl_error *error)
{
    struct tl_taken unused;
    tl_frame frame = tl_extreme_frame(scene);
    struct tl_variant_run changed = *variant;
    struct tl_binding light = {&tl_light_options, &changed.settings.light};
    changed.settings.image.ground = scene->ground;
    /* Its surfaces reflect more light than they receive, as no cloth does: what that does to light that
     * bounces is said by extremes of its own, and would hide what all others are about. */
    changed.settings.light.bounce = TL_BOUNCE_OFF;
    for (size_t i = 0; i < TL_COUNT(extreme->assignments) && extreme->assignments[i]; i++)
        if (!tl_options_set_assignment(&light, 1, extreme->assignments[i], error))
            return false;
    return tl_variant_run_draw(&changed, &frame, &unused, error) &&
           tl_renderer_read(variant->renderer, out, error);
}

static struct light_cell judge(const struct tl_extreme *extreme, const tl_image *image,
                               const tl_image *reference, double bound)
{
    struct light_cell cell = {.outcome = TL_OUTCOME_SILENT, .rel_rmse = NAN, .bound = bound};
    if (has_nan(image) || has_nan(reference))
        cell.outcome = TL_OUTCOME_NAN;
    else if (extreme->refused)
        tl_fail(&cell.error, TL_UNSTABLE, "drawn, though %s", extreme->why);
    else if (!relative_error(image, reference, &cell.rel_rmse, &cell.error))
        cell.rel_rmse = NAN;
    else if (cell.rel_rmse <= EXACT_RMSE)
        cell.outcome = TL_OUTCOME_EXACT;
    else if (cell.rel_rmse <= bound)
        cell.outcome = TL_OUTCOME_BOUNDED;
    return cell;
}

/* A refusal counts if it was expected and its message is not empty. */
static struct light_cell refuse(const struct tl_extreme *extreme, const tl_error *error)
{
    bool clear =
        extreme->refused && error->message[0] && (error->code == TL_USAGE || error->code == TL_INPUT);
    struct light_cell cell = {.outcome = clear ? TL_OUTCOME_REFUSED : TL_OUTCOME_SILENT,
                              .rel_rmse = NAN,
                              .bound = NAN,
                              .error = *error};
    return cell;
}

/* The bound of one method; NaN, which nothing keeps, when there is nothing to compare with. */
static double bound_of(struct light_suite *suite, const struct tl_extreme *extreme, int method,
                       struct tl_extreme_scene *scene, const tl_image *reference)
{
    if (extreme->bounds[method] != TL_NO_WORSE)
        return extreme->bounds[method];
    tl_image image = {0};
    double bound = NAN;
    tl_error error;
    if (picture(&suite->unshadowed, extreme, scene, &image, &error))
        relative_error(&image, reference, &bound, &error);
    tl_image_release(&image);
    return bound;
}

static void run_extreme(struct light_suite *suite, size_t index)
{
    const struct tl_extreme *extreme = &tl_extremes[index];
    struct tl_extreme_scene scene;
    tl_error error = {0};
    tl_image reference = {0};
    bool made = tl_extreme_scene_make(extreme, &scene, &error) &&
                (extreme->refused || picture(&suite->reference, extreme, &scene, &reference, &error));
    for (int m = 0; m < TL_EXTREME_METHODS; m++) {
        tl_image image = {0};
        struct light_cell *cell = &suite->cells[index * TL_EXTREME_METHODS + (size_t)m];
        if (made && picture(&suite->methods[m], extreme, &scene, &image, &error))
            *cell = judge(extreme, &image, extreme->refused ? &image : &reference,
                          extreme->refused ? NAN : bound_of(suite, extreme, m, &scene, &reference));
        else
            *cell = refuse(extreme, &error);
        tl_image_release(&image);
    }
    tl_image_release(&reference);
    tl_extreme_scene_release(&scene);
}

static bool run(struct light_suite *suite, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("drawing extremes");
    bool done = true;
    for (size_t i = 0; done && i < tl_extreme_count; i += suite->stride) {
        run_extreme(suite, i);
        if (tl_interrupted())
            done = tl_fail(error, TL_INTERRUPTED, "stability: stopped at extreme %zu of %zu", i,
                           tl_extreme_count);
        tl_progress_update(&progress, (double)i + 1, (double)tl_extreme_count);
    }
    tl_progress_end(&progress);
    return done;
}

static void print_table(const struct light_suite *suite)
{
    printf("%-31s %-6s %-8s %9s %8s  %s\n", "extreme", "", "", "rel. RMSE", "bound", "why");
    for (size_t i = 0; i < tl_extreme_count; i += suite->stride)
        for (int m = 0; m < TL_EXTREME_METHODS; m++) {
            const struct light_cell *cell = &suite->cells[i * TL_EXTREME_METHODS + (size_t)m];
            printf("%-31s %-6s %-8s", m == 0 ? tl_extremes[i].name : "", method_names[m],
                   tl_outcome_names[cell->outcome]);
            if (isfinite(cell->rel_rmse) && !tl_extremes[i].refused)
                printf(" %8.2f%% %7.0f%%  ", 100 * cell->rel_rmse, 100 * cell->bound);
            else
                printf(" %9s %8s  ", "", "");
            printf("%s\n", cell->error.message[0] ? cell->error.message : tl_extremes[i].why);
        }
}

static cJSON *number_or_null(double number)
{
    return isfinite(number) ? cJSON_CreateNumber(number) : cJSON_CreateNull();
}

static void add_cells(const struct light_suite *suite, struct tl_stability *out)
{
    for (size_t i = 0; i < tl_extreme_count; i += suite->stride)
        for (int m = 0; m < TL_EXTREME_METHODS; m++) {
            const struct light_cell *cell = &suite->cells[i * TL_EXTREME_METHODS + (size_t)m];
            cJSON *row = tl_stability_add(out, "light", cell->outcome);
            cJSON_AddStringToObject(row, "extreme", tl_extremes[i].name);
            cJSON_AddStringToObject(row, "method", method_names[m]);
            cJSON_AddItemToObject(row, "rel_rmse", number_or_null(cell->rel_rmse));
            cJSON_AddItemToObject(row, "bound", number_or_null(cell->bound));
            cJSON_AddStringToObject(row, "why",
                                    cell->error.message[0] ? cell->error.message : tl_extremes[i].why);
        }
}

bool tl_stability_light(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error)
{
    struct light_suite suite = {.stride = arguments->quick ? QUICK_STRIDE : 1};
    struct tl_arguments scene = *arguments;
    tl_topic_default_scene(&scene, "review");
    bool done = prepare(&suite, &scene, error) && run(&suite, error);
    if (done && !arguments->json)
        print_table(&suite);
    if (done)
        add_cells(&suite, out);
    release(&suite);
    return done;
}
