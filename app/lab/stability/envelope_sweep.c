#include "app/lab/stability/envelope_sweep.h"

#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <stdio.h>
#include <stdlib.h>

#define TUBE_M     1.0
#define LARGE_STEP 2 /* 1 ms, of the sizes that are not run whole */

static size_t index_of(struct tl_envelope_place at)
{
    size_t index = (size_t)at.solver * tl_envelope_size_count + at.size;
    index = index * TL_ENVELOPE_RATIOS + (size_t)at.ratio;
    index = index * TL_ENVELOPE_STEPS + (size_t)at.step;
    return index * TL_ENVELOPE_STIFFNESSES + (size_t)at.stiffness;
}

const struct tl_envelope_cell *tl_envelope_at(const struct tl_envelope_sweep *sweep,
                                              struct tl_envelope_place at)
{
    return &sweep->cells[index_of(at)];
}

struct tl_envelope_place tl_envelope_place_of(size_t index)
{
    struct tl_envelope_place at;
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

/* Whether a place of the envelope is run. Large sizes are run only with the softest, an ordinary and the
 * stiffest cloth, evenly meshed. */
static bool is_asked_for(bool quick, struct tl_envelope_place at)
{
    const struct tl_envelope_size *size = &tl_envelope_sizes[at.size];
    if (quick && (!size->quick || at.stiffness % 3 != 2 || at.step % 2))
        return false;
    if (size->columns == 0 && at.ratio > 0)
        return false; /* a triangle's masses are alike */
    bool sparse = at.ratio == 0 && at.step == LARGE_STEP &&
                  (at.stiffness == 0 || at.stiffness == 5 || at.stiffness == TL_ENVELOPE_STIFFNESSES - 1);
    return size->whole || sparse;
}

bool tl_envelope_sweep_run(bool quick, struct tl_envelope_sweep *out, tl_error *error)
{
    struct tl_progress progress = tl_progress_begin("sweeping the envelope of cloth");
    bool done = true;
    out->count = TL_CLOTH_SOLVER_COUNT * tl_envelope_size_count * TL_ENVELOPE_RATIOS * TL_ENVELOPE_STEPS *
                 TL_ENVELOPE_STIFFNESSES;
    out->cells = TL_NEW_ARRAY(struct tl_envelope_cell, out->count);
    for (size_t i = 0; done && i < out->count; i++) {
        struct tl_envelope_place at = tl_envelope_place_of(i);
        const struct tl_envelope_case tested = {
            .size = &tl_envelope_sizes[at.size],
            .solver = at.solver,
            .stiffness = tl_envelope_stiffnesses[at.stiffness],
            .dt = tl_envelope_steps[at.step],
            .mass_ratio = tl_envelope_ratios[at.ratio],
            .height_m = TUBE_M,
        };
        if (is_asked_for(quick, at))
            out->cells[i] = tl_envelope_run(&tested);
        if (tl_interrupted())
            done = tl_fail(error, TL_INTERRUPTED, "stability: stopped at cell %zu of %zu", i, out->count);
        tl_progress_update(&progress, (double)i + 1, (double)out->count);
    }
    tl_progress_end(&progress);
    return done;
}

void tl_envelope_sweep_release(struct tl_envelope_sweep *sweep)
{
    free(sweep->cells);
    *sweep = (struct tl_envelope_sweep){0};
}

/* Prints one line of letters for a mass ratio; false if no cell of it was run. */
static bool spell_line(const struct tl_envelope_sweep *sweep, int solver, size_t size, int step,
                       char lines[TL_ENVELOPE_RATIOS][TL_ENVELOPE_STIFFNESSES + 1])
{
    static const char letters[TL_OUTCOME_COUNT + 1] = "=bc.S!";
    bool any = false;
    for (int ratio = 0; ratio < TL_ENVELOPE_RATIOS; ratio++) {
        for (int k = 0; k < TL_ENVELOPE_STIFFNESSES; k++) {
            const struct tl_envelope_cell *cell =
                tl_envelope_at(sweep, (struct tl_envelope_place){solver, ratio, step, k, size});
            lines[ratio][k] = cell->run ? letters[cell->outcome] : ' ';
            any |= cell->run;
        }
        lines[ratio][TL_ENVELOPE_STIFFNESSES] = '\0';
    }
    return any;
}

void tl_envelope_print(const struct tl_envelope_sweep *sweep)
{
    char lines[TL_ENVELOPE_RATIOS][TL_ENVELOPE_STIFFNESSES + 1];
    printf(
        "the envelope of cloth, stiffness 1e-2 to 1e9 N/m from left to right\n"
        "= exact   b bounded   c coarse   . refused   S SILENT   ! NaN   (space: not run)\n\n%-12s%-12s%-8s",
        "solver", "particles", "dt");
    for (int ratio = 0; ratio < TL_ENVELOPE_RATIOS; ratio++)
        printf("  masses 1:%-5.0g", tl_envelope_ratios[ratio]);
    putchar('\n');
    for (int solver = 0; solver < TL_CLOTH_SOLVER_COUNT; solver++)
        for (size_t size = 0; size < tl_envelope_size_count; size++)
            for (int step = 0; step < TL_ENVELOPE_STEPS; step++) {
                if (!spell_line(sweep, solver, size, step, lines))
                    continue;
                printf("%-12s%-12s%-8g", tl_cloth_solver_names[solver], tl_envelope_sizes[size].name,
                       tl_envelope_steps[step]);
                for (int ratio = 0; ratio < TL_ENVELOPE_RATIOS; ratio++)
                    printf("  %-14s", lines[ratio]);
                putchar('\n');
            }
}
