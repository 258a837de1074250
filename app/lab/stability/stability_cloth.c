/* The extremes of cloth: the envelope over stiffness, step, mass ratio and size, then single extremes. */
#include "app/lab/stability/envelope_sweep.h"
#include "app/lab/stability/extremes_cloth.h"
#include "app/lab/stability/stability.h"
#include "app/measure/cost.h"
#include "assets/image/image_file.h"
#include "config/base/file.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct single {
    bool run;
    enum tl_outcome outcome;
    struct tl_cell_error error;
    double cpu_ms;
    tl_error message;
};

struct cloth_suite {
    struct tl_envelope_sweep sweep;
    struct single *singles; /* [tl_cloth_extreme_count][TL_CLOTH_SOLVER_COUNT] */
};

static bool run_singles(struct cloth_suite *suite, bool quick, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("trying the extremes of cloth");
    size_t count = tl_cloth_extreme_count * TL_CLOTH_SOLVER_COUNT;
    suite->singles = TL_NEW_ARRAY(struct single, count);
    for (size_t i = 0; i < count && !tl_interrupted(); i++) {
        struct single *single = &suite->singles[i];
        struct tl_stopwatch watch = tl_stopwatch_start();
        size_t extreme = i / TL_CLOTH_SOLVER_COUNT;
        int solver = (int)(i % TL_CLOTH_SOLVER_COUNT);
        single->run = !(quick && solver != TL_CLOTH_PREVIEW && tl_cloth_extreme_is_slow(extreme));
        if (single->run)
            single->outcome = tl_cloth_extreme_run(extreme, solver, &single->error, &single->message);
        single->cpu_ms = tl_stopwatch_read(&watch).cpu_ms;
        tl_progress_update(&progress, (double)i + 1, (double)count);
    }
    tl_progress_end(&progress);
    return !tl_interrupted() ||
           tl_fail(error, TL_INTERRUPTED, "stability: stopped among the extremes of cloth");
}

static void print_singles(const struct cloth_suite *suite)
{
    printf("\n%-36s%-12s%-8s %9s %14s\n", "extreme", "solver", "", "error", "");
    for (size_t i = 0; i < tl_cloth_extreme_count; i++)
        for (size_t s = 0; s < TL_CLOTH_SOLVER_COUNT; s++) {
            const struct single *single = &suite->singles[i * TL_CLOTH_SOLVER_COUNT + s];
            if (!single->run)
                continue;
            printf("%-36s%-12s%-8s", s == 0 ? tl_cloth_extreme_name(i) : "", tl_cloth_solver_names[s],
                   tl_outcome_names[single->outcome]);
            tl_cell_error_print(&single->error);
            printf("  %s\n", single->message.message);
        }
}

/* The largest error of the cells of each outcome that have one. */
static void print_largest(const struct tl_envelope_sweep *sweep)
{
    for (int outcome = TL_OUTCOME_EXACT; outcome <= TL_OUTCOME_COARSE; outcome++) {
        struct tl_cell_error largest = {.share = -1, .unit = ""};
        for (size_t i = 0; i < sweep->count; i++)
            if (sweep->cells[i].run && (int)sweep->cells[i].outcome == outcome &&
                sweep->cells[i].error.share > largest.share)
                largest = sweep->cells[i].error;
        if (largest.share >= 0)
            printf("largest error of %s cells: %.3g %% of the tube, %.3g %s\n", tl_outcome_names[outcome],
                   100 * largest.share, largest.own, largest.unit);
    }
}

static void print_failures(const struct tl_envelope_sweep *sweep)
{
    for (size_t i = 0; i < sweep->count; i++) {
        const struct tl_envelope_cell *cell = &sweep->cells[i];
        struct tl_envelope_place at = tl_envelope_place_of(i);
        if (cell->run && cell->outcome >= TL_OUTCOME_SILENT)
            printf("%s: %s, %s particles, k %g, dt %g, masses 1:%g: %s\n", tl_outcome_names[cell->outcome],
                   tl_cloth_solver_names[at.solver], tl_envelope_sizes[at.size].name,
                   tl_envelope_stiffnesses[at.stiffness], tl_envelope_steps[at.step],
                   tl_envelope_ratios[at.ratio], cell->message.message);
    }
}

static cJSON *number_or_null(double number)
{
    return isfinite(number) ? cJSON_CreateNumber(number) : cJSON_CreateNull();
}

static void add_cells(const struct cloth_suite *suite, struct tl_stability *out)
{
    const struct tl_envelope_sweep *sweep = &suite->sweep;
    for (size_t i = 0; i < sweep->count; i++) {
        const struct tl_envelope_cell *cell = &sweep->cells[i];
        struct tl_envelope_place at = tl_envelope_place_of(i);
        if (!cell->run)
            continue;
        cJSON *row = tl_stability_add(out, "cloth", cell->outcome, &cell->error);
        cJSON_AddStringToObject(row, "solver", tl_cloth_solver_names[at.solver]);
        cJSON_AddStringToObject(row, "particles", tl_envelope_sizes[at.size].name);
        cJSON_AddNumberToObject(row, "stiffness", tl_envelope_stiffnesses[at.stiffness]);
        cJSON_AddNumberToObject(row, "dt", tl_envelope_steps[at.step]);
        cJSON_AddNumberToObject(row, "mass_ratio", tl_envelope_ratios[at.ratio]);
        cJSON_AddItemToObject(row, "strayed", number_or_null(cell->strayed));
        cJSON_AddItemToObject(row, "growth", number_or_null(cell->growth));
        cJSON_AddNumberToObject(row, "cpu_ms", cell->cpu_ms);
        cJSON_AddStringToObject(row, "why", cell->message.message);
    }
    for (size_t i = 0; i < tl_cloth_extreme_count * TL_CLOTH_SOLVER_COUNT; i++) {
        const struct single *single = &suite->singles[i];
        if (!single->run)
            continue;
        cJSON *row = tl_stability_add(out, "cloth", single->outcome, &single->error);
        cJSON_AddStringToObject(row, "extreme", tl_cloth_extreme_name(i / TL_CLOTH_SOLVER_COUNT));
        cJSON_AddStringToObject(row, "solver", tl_cloth_solver_names[i % TL_CLOTH_SOLVER_COUNT]);
        cJSON_AddNumberToObject(row, "cpu_ms", single->cpu_ms);
        cJSON_AddStringToObject(row, "why", single->message.message);
    }
}

static bool save_picture(const struct tl_envelope_sweep *sweep, const char *folder, tl_error *error)
{
    tl_image picture = tl_envelope_picture(sweep);
    char *path = tl_format("%s/cloth.png", folder);
    bool saved = tl_folder_make(folder, error) && tl_image_save_png(path, &picture, error);
    free(path);
    tl_image_release(&picture);
    return saved;
}

bool tl_stability_cloth(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error)
{
    struct cloth_suite suite = {0};
    bool done = tl_envelope_sweep_run(arguments->quick, &suite.sweep, error) &&
                run_singles(&suite, arguments->quick, error);
    if (done && !arguments->json) {
        tl_envelope_print(&suite.sweep);
        print_largest(&suite.sweep);
        print_failures(&suite.sweep);
        print_singles(&suite);
    }
    if (done)
        add_cells(&suite, out);
    if (done && arguments->output)
        done = save_picture(&suite.sweep, arguments->output, error);
    tl_envelope_sweep_release(&suite.sweep);
    free(suite.singles);
    return done;
}
