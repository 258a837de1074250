/* The extremes of cloth: the envelope over stiffness, step, mass ratio and size, then single extremes. */
#include "app/envelope.h"
#include "config/interrupt.h"
#include "config/log.h"
#include "config/memory.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TUBE_M 1.0
/* Of the sizes that are not run whole. */
#define LARGE_STEP 2 /* 1 ms */

struct suite {
    bool quick;
    struct tl_envelope_cell *cells; /* [solver][size][ratio][step][stiffness] */
};

struct place {
    int solver, ratio, step, stiffness;
    size_t size;
};

static struct tl_envelope_cell *cell_at(const struct suite *suite, struct place at)
{
    size_t index = (size_t)at.solver * tl_envelope_size_count + at.size;
    index = index * TL_ENVELOPE_RATIOS + (size_t)at.ratio;
    index = index * TL_ENVELOPE_STEPS + (size_t)at.step;
    return &suite->cells[index * TL_ENVELOPE_STIFFNESSES + (size_t)at.stiffness];
}

static struct place place_of(size_t index)
{
    struct place at;
    at.stiffness = (int)(index % TL_ENVELOPE_STIFFNESSES);
    index /= TL_ENVELOPE_STIFFNESSES;
    at.step = (int)(index % TL_ENVELOPE_STEPS);
    index /= TL_ENVELOPE_STEPS;
    at.ratio = (int)(index % TL_ENVELOPE_RATIOS);
    index /= TL_ENVELOPE_RATIOS;
    at.size = index % tl_envelope_size_count;
    at.solver = (int)(index / tl_envelope_size_count);
    return at;
}

static size_t cell_count(void)
{
    return TL_CLOTH_SOLVER_COUNT * tl_envelope_size_count * TL_ENVELOPE_RATIOS * TL_ENVELOPE_STEPS *
           TL_ENVELOPE_STIFFNESSES;
}

/* Large sizes: the softest, an ordinary and the stiffest cloth, evenly meshed. */
static bool is_asked_for(const struct suite *suite, struct place at)
{
    const struct tl_envelope_size *size = &tl_envelope_sizes[at.size];
    if (suite->quick && (!size->quick || at.stiffness % 3 != 2 || at.step % 2))
        return false;
    if (size->columns == 0 && at.ratio > 0)
        return false; /* a triangle's masses are alike */
    bool sparse = at.ratio == 0 && at.step == LARGE_STEP &&
                  (at.stiffness == 0 || at.stiffness == 5 || at.stiffness == TL_ENVELOPE_STIFFNESSES - 1);
    return size->whole || sparse;
}

static bool run_envelope(struct suite *suite, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("sweeping the envelope of cloth");
    size_t count = cell_count();
    bool done = true;
    suite->cells = TL_NEW_ARRAY(struct tl_envelope_cell, count);
    for (size_t i = 0; done && i < count; i++) {
        struct place at = place_of(i);
        const struct tl_envelope_case tested = {
            .size = &tl_envelope_sizes[at.size],
            .solver = at.solver,
            .stiffness = tl_envelope_stiffnesses[at.stiffness],
            .dt = tl_envelope_steps[at.step],
            .mass_ratio = tl_envelope_ratios[at.ratio],
            .height_m = TUBE_M,
        };
        if (is_asked_for(suite, at))
            suite->cells[i] = tl_envelope_run(&tested);
        if (tl_interrupted())
            done = tl_fail(error, TL_INTERRUPTED, "stability: stopped at cell %zu of %zu", i, count);
        tl_progress_update(&progress, (double)i + 1, (double)count);
    }
    tl_progress_end(&progress);
    return done;
}

static const char letters[TL_OUTCOME_COUNT + 1] = "=b.S!";

static void print_maps(const struct suite *suite)
{
    printf("the envelope of cloth, stiffness 1e-2 to 1e9 N/m from left to right:\n"
           "= exact   b bounded   . refused   S SILENT   ! NaN   (space: not asked for)\n\n%-12s%-12s%-8s",
           "solver", "particles", "dt");
    for (int ratio = 0; ratio < TL_ENVELOPE_RATIOS; ratio++)
        printf("  masses 1:%-4.0g", tl_envelope_ratios[ratio]);
    putchar('\n');
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++)
        for (size_t size = 0; size < tl_envelope_size_count; size++)
            for (int step = 0; step < TL_ENVELOPE_STEPS; step++) {
                char lines[TL_ENVELOPE_RATIOS][TL_ENVELOPE_STIFFNESSES + 1] = {0};
                bool any = false;
                for (int ratio = 0; ratio < TL_ENVELOPE_RATIOS; ratio++)
                    for (int k = 0; k < TL_ENVELOPE_STIFFNESSES; k++) {
                        const struct tl_envelope_cell *cell =
                            cell_at(suite, (struct place){solver, ratio, step, k, size});
                        lines[ratio][k] = cell->run ? letters[cell->outcome] : ' ';
                        any |= cell->run;
                    }
                if (!any)
                    continue;
                printf("%-12s%-12s%-8g", tl_cloth_solver_names[solver], tl_envelope_sizes[size].name,
                       tl_envelope_steps[step]);
                for (int ratio = 0; ratio < TL_ENVELOPE_RATIOS; ratio++)
                    printf("  %s", lines[ratio]);
                putchar('\n');
            }
}

static cJSON *number_or_null(double number)
{
    return isfinite(number) ? cJSON_CreateNumber(number) : cJSON_CreateNull();
}

static void add_cells(const struct suite *suite, struct tl_stability *out)
{
    for (size_t i = 0, count = cell_count(); i < count; i++) {
        const struct tl_envelope_cell *cell = &suite->cells[i];
        struct place at = place_of(i);
        if (!cell->run)
            continue;
        cJSON *row = tl_stability_add(out, "cloth", cell->outcome);
        cJSON_AddStringToObject(row, "solver", tl_cloth_solver_names[at.solver]);
        cJSON_AddStringToObject(row, "particles", tl_envelope_sizes[at.size].name);
        cJSON_AddNumberToObject(row, "stiffness", tl_envelope_stiffnesses[at.stiffness]);
        cJSON_AddNumberToObject(row, "dt", tl_envelope_steps[at.step]);
        cJSON_AddNumberToObject(row, "mass_ratio", tl_envelope_ratios[at.ratio]);
        cJSON_AddItemToObject(row, "strayed", number_or_null(cell->strayed));
        cJSON_AddItemToObject(row, "growth", number_or_null(cell->growth));
        cJSON_AddNumberToObject(row, "cpu_ms", cell->cpu_ms);
        cJSON_AddStringToObject(row, "why", cell->error.message);
    }
}

bool tl_stability_cloth(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error)
{
    struct suite suite = {.quick = arguments->quick};
    bool done = run_envelope(&suite, error);
    if (done && !arguments->json)
        print_maps(&suite);
    if (done)
        add_cells(&suite, out);
    free(suite.cells);
    return done;
}
