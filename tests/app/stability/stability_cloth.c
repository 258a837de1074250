/* The extremes of cloth: the envelope over stiffness, step, mass ratio and size, then single extremes. */
#include "app/cli/json.h"
#include "app/measure/cost.h"
#include "config/base/interrupt.h"
#include "config/base/log.h"
#include "config/base/memory.h"
#include "tests/app/stability/envelope.h"
#include "tests/app/stability/extremes_cloth.h"
#include "tests/app/stability/stability.h"

#define TUBE_M 1.0

/* An index of each of the envelope's dimensions. */
struct place {
    size_t solver, size, ratio, step, stiffness;
};

static struct place place_of(size_t index)
{
    struct place at;
    at.stiffness = index % TL_ENVELOPE_STIFFNESSES;
    index /= TL_ENVELOPE_STIFFNESSES;
    at.step = index % TL_ENVELOPE_STEPS;
    index /= TL_ENVELOPE_STEPS;
    at.ratio = index % TL_ENVELOPE_RATIOS;
    index /= TL_ENVELOPE_RATIOS;
    at.size = index % tl_envelope_size_count;
    at.solver = index / tl_envelope_size_count;
    return at;
}

/* Whether a place of the envelope is run. Large sizes are run with the softest, an ordinary and the stiffest
 * cloth, evenly meshed, at steps of 1 ms. */
static bool is_run(struct place at, bool quick)
{
    const struct tl_envelope_size *size = &tl_envelope_sizes[at.size];
    if (quick && (!size->quick || at.stiffness % 3 != 2 || at.step % 2 || at.ratio == 1))
        return false;
    if (size->columns == 0 && at.ratio > 0)
        return false; /* a triangle's masses are alike */
    bool sparse = at.ratio == 0 && tl_envelope_steps[at.step] == 1e-3 &&
                  (at.stiffness == 0 || at.stiffness == 5 || at.stiffness == TL_ENVELOPE_STIFFNESSES - 1);
    return size->whole || sparse;
}

static void run_place(struct place at, struct tl_stability *out)
{
    const struct tl_envelope_case tested = {
        .size = &tl_envelope_sizes[at.size],
        .solver = (int)at.solver,
        .stiffness = tl_envelope_stiffnesses[at.stiffness],
        .dt = tl_envelope_steps[at.step],
        .mass_ratio = tl_envelope_ratios[at.ratio],
        .height_m = TUBE_M,
    };
    const struct tl_envelope_cell cell = tl_envelope_run(&tested);
    cJSON *row = tl_stability_add(out, "cloth", cell.outcome, &cell.error);
    cJSON_AddStringToObject(row, "solver", tl_cloth_solver_names[at.solver]);
    cJSON_AddStringToObject(row, "particles", tested.size->name);
    cJSON_AddNumberToObject(row, "stiffness", tested.stiffness);
    cJSON_AddNumberToObject(row, "dt", tested.dt);
    cJSON_AddNumberToObject(row, "mass_ratio", tested.mass_ratio);
    tl_json_add_number(row, "strayed", cell.strayed);
    tl_json_add_number(row, "growth", cell.growth);
    cJSON_AddNumberToObject(row, "cpu_ms", cell.cpu_ms);
    cJSON_AddStringToObject(row, "why", cell.message.message);
}

static void run_extreme(size_t extreme, int solver, struct tl_stability *out)
{
    struct tl_stopwatch watch = tl_stopwatch_start();
    struct tl_cell_error error;
    tl_error message;
    enum tl_outcome outcome = tl_cloth_extreme_run(extreme, solver, &error, &message);
    double cpu_ms = tl_stopwatch_read(&watch).cpu_ms;
    cJSON *row = tl_stability_add(out, "cloth", outcome, &error);
    cJSON_AddStringToObject(row, "extreme", tl_cloth_extreme_name(extreme));
    cJSON_AddStringToObject(row, "solver", tl_cloth_solver_names[solver]);
    cJSON_AddNumberToObject(row, "cpu_ms", cpu_ms);
    cJSON_AddStringToObject(row, "why", message.message);
}

bool tl_stability_cloth(const struct tl_arguments *arguments, struct tl_stability *out, tl_error *error)
{
    bool quick = arguments->quick;
    size_t places = TL_CLOTH_SOLVER_COUNT * tl_envelope_size_count * TL_ENVELOPE_RATIOS * TL_ENVELOPE_STEPS *
                    TL_ENVELOPE_STIFFNESSES;
    size_t count = places + tl_cloth_extreme_count * TL_CLOTH_SOLVER_COUNT;
    struct tl_progress progress = tl_progress_begin("running the extremes of cloth");
    for (size_t i = 0; i < count && !tl_interrupted(); i++) {
        size_t extreme = i < places ? 0 : (i - places) / TL_CLOTH_SOLVER_COUNT;
        int solver = (int)((i - places) % TL_CLOTH_SOLVER_COUNT);
        if (i < places && is_run(place_of(i), quick))
            run_place(place_of(i), out);
        else if (i >= places && !(quick && solver != TL_CLOTH_PREVIEW && tl_cloth_extreme_is_slow(extreme)))
            run_extreme(extreme, solver, out);
        tl_progress_update(&progress, (double)i + 1, (double)count);
    }
    tl_progress_end(&progress);
    return !tl_interrupted() ||
           tl_fail(error, TL_INTERRUPTED, "stability: stopped among the extremes of cloth");
}
