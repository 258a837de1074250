#include "app/budget/governor.h"

#include "config/log.h"
#include "config/memory.h"
#include "render/plan/budget.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Frames without a change before the image counts as one to be looked at. */
#define REST_FRAMES 3

struct tl_pace {
    double budget_ms;
    struct tl_governor governor;
    int level_counts[TL_KNOB_COUNT]; /* as the settings have them */
    struct tl_pace_choice choice;
    struct tl_cost_job cloth, other; /* what is not the renderer's */
    struct tl_work cloth_work;
    double load;       /* when that was chosen */
    bool is_preparing; /* that frame did what no other does */
    int rested;        /* frames without a change */
    uint64_t environment_revision;
};

tl_pace *tl_pace_create(double budget_ms)
{
    tl_pace *pace = TL_NEW(tl_pace);
    pace->budget_ms = budget_ms;
    pace->load = 1;
    pace->choice.predicted_ms = (double)NAN;
    return pace;
}

void tl_pace_destroy(tl_pace **handle)
{
    free(*handle);
    *handle = NULL;
}

void tl_pace_set_budget(tl_pace *pace, double budget_ms)
{
    pace->budget_ms = budget_ms;
}

/* ---- What levels cost ---- */

/* What is always there, then substeps; ms of the built-in dress. */
static struct tl_work cloth_work(const struct tl_level_scope *scope)
{
    return (struct tl_work){{1, 0.1 * tl_level_value(TL_KNOB_CLOTH, scope)}};
}

static const struct tl_work any_work = {{1}};

struct coming {
    const tl_pace *pace;
    const tl_renderer *renderer;
    struct tl_level_scope full;
    tl_bits running;                     /* jobs, at the levels of the last frame */
    tl_bits started[TL_KNOB_COUNT];      /* ... and with those that another level of a knob starts */
    bool is_ready[TL_BUDGET_LEVELS_MAX]; /* levels of regions */
};

static double known_ms(const struct tl_cost_job *job, const struct tl_work *work, double load)
{
    return job->runs > 0 ? tl_cost_predict(job, work, load) : 0;
}

static struct tl_levels levels_of(const uint8_t *of)
{
    struct tl_levels levels;
    memcpy(levels.of, of, sizeof levels.of);
    return levels;
}

/* Of a frame after one at the same levels. */
static double cost_of(const void *context, const uint8_t *of)
{
    const struct coming *coming = context;
    const tl_pace *pace = coming->pace;
    const struct tl_levels levels = levels_of(of);
    if (!coming->is_ready[levels.of[TL_KNOB_REGIONS]])
        return INFINITY;
    const struct tl_level_scope applied = tl_level_scope_at(&levels, &coming->full);
    double load = tl_renderer_load(coming->renderer);
    struct tl_work cloth = cloth_work(&applied);
    return tl_renderer_would_take(coming->renderer, &applied.drawn, coming->running) +
           known_ms(&pace->cloth, &cloth, load) + known_ms(&pace->other, &any_work, load);
}

/* Jobs that run for other levels than the last frame's, and cloth whose step becomes shorter: it finds its
 * contacts anew, and takes three times as long for a few frames (built-in dress: 31, 31, 24, 15 ms, then 11).
 */
static double change_of(const void *context, const uint8_t *of)
{
    const double anew = 2;
    const struct coming *coming = context;
    const tl_pace *pace = coming->pace;
    const struct tl_levels levels = levels_of(of);
    tl_bits jobs = 0;
    for (int k = 0; k < TL_KNOB_COUNT; k++)
        jobs |= of[k] != pace->choice.levels.of[k] ? coming->started[k] & ~coming->running : 0;
    bool is_shorter = of[TL_KNOB_CLOTH] < pace->choice.levels.of[TL_KNOB_CLOTH];
    if (!jobs && !is_shorter)
        return 0;
    const struct tl_level_scope applied = tl_level_scope_at(&levels, &coming->full);
    struct tl_work cloth = cloth_work(&applied);
    return tl_renderer_would_take(coming->renderer, &applied.drawn, jobs) +
           (is_shorter ? anew * known_ms(&pace->cloth, &cloth, tl_renderer_load(coming->renderer)) : 0);
}

static double error_of(const void *context, const uint8_t *of)
{
    const struct coming *coming = context;
    const struct tl_levels levels = levels_of(of);
    return tl_levels_error(&levels, &coming->full);
}

static struct tl_level_scope at_level(const struct coming *coming, int knob, int level)
{
    struct tl_levels levels = coming->pace->choice.levels;
    levels.of[knob] = (uint8_t)level;
    return tl_level_scope_at(&levels, &coming->full);
}

/* A level other than the last frame's sets jobs going that would have been reused. */
static struct coming look_ahead(const tl_pace *pace, const tl_renderer *renderer, const tl_frame *frame,
                                const struct tl_level_scope *full)
{
    struct coming coming = {.pace = pace, .renderer = renderer, .full = *full};
    struct tl_level_scope now = tl_level_scope_at(&pace->choice.levels, full);
    coming.running = tl_renderer_would_run(renderer, frame, &now.drawn);
    for (int knob = 0; knob < TL_KNOB_COUNT; knob++) {
        int level = pace->choice.levels.of[knob], other = level > 0 ? level - 1 : level + 1;
        struct tl_level_scope then = at_level(&coming, knob, other);
        if (other < pace->level_counts[knob] && knob != TL_KNOB_CLOTH)
            coming.started[knob] = tl_renderer_would_run(renderer, frame, &then.drawn);
    }
    for (int level = 0; level < pace->level_counts[TL_KNOB_REGIONS]; level++) {
        struct tl_level_scope then = at_level(&coming, TL_KNOB_REGIONS, level);
        coming.is_ready[level] = level == pace->choice.levels.of[TL_KNOB_REGIONS] ||
                                 tl_renderer_has_regions(renderer, &then.drawn);
    }
    return coming;
}

static struct tl_budget budget_of(const tl_pace *pace, const struct coming *coming)
{
    struct tl_budget budget = {.knob_count = TL_KNOB_COUNT,
                               .cost = cost_of,
                               .change = change_of,
                               .error = error_of,
                               .context = coming};
    memcpy(budget.level_counts, pace->level_counts, sizeof pace->level_counts);
    return budget;
}

/* One level a frame, the cheapest first, as long as the environment stays what it is. */
static void prepare_regions(tl_pace *pace, tl_renderer *renderer, const tl_frame *frame,
                            const struct tl_level_scope *full)
{
    pace->is_preparing = false;
    bool stays = pace->environment_revision == frame->environment_revision;
    pace->environment_revision = frame->environment_revision;
    for (int level = pace->level_counts[TL_KNOB_REGIONS] - 1; stays && level >= 0; level--) {
        struct tl_levels levels = {{0}};
        levels.of[TL_KNOB_REGIONS] = (uint8_t)level;
        struct tl_level_scope then = tl_level_scope_at(&levels, full);
        if (tl_renderer_has_regions(renderer, &then.drawn))
            continue;
        tl_renderer_prepare_regions(renderer, &then.drawn);
        pace->is_preparing = true;
        return;
    }
}

/* ---- The choice ---- */

static void say(char *out, size_t size, const char *before, const struct tl_levels *old,
                const struct tl_levels *new, double ms, double budget_ms)
{
    size_t length = (size_t)snprintf(out, size, "%s:", before);
    for (int k = 0; k < TL_KNOB_COUNT && length < size; k++)
        if (old->of[k] != new->of[k])
            length += (size_t)snprintf(out + length, size - length, " %s %d to %d,", tl_knob_names[k],
                                       old->of[k], new->of[k]);
    if (length < size)
        snprintf(out + length, size - length, " for %.1f of %.1f ms", ms, budget_ms);
}

/* Whoever is over the budget is asked whether anything is cheaper. */
static double least_of(const struct tl_budget *budget, double budget_ms, double predicted_ms)
{
    uint8_t levels[TL_BUDGET_KNOBS_MAX] = {0};
    if (predicted_ms <= budget_ms)
        return predicted_ms;
    tl_budget_best(budget, budget_ms, INFINITY, levels);
    return budget->cost(budget->context, levels);
}

static void choose_in_motion(tl_pace *pace, const struct tl_budget *budget)
{
    struct tl_pace_choice *choice = &pace->choice;
    struct tl_levels before = choice->levels;
    enum tl_governed how = tl_governor_choose(&pace->governor, budget, pace->budget_ms);
    choice->change_ms = budget->change(budget->context, pace->governor.levels);
    choice->predicted_ms = budget->cost(budget->context, pace->governor.levels) + choice->change_ms;
    choice->least_ms = least_of(budget, pace->budget_ms, choice->predicted_ms);
    memcpy(choice->levels.of, pace->governor.levels, sizeof choice->levels.of);
    if (how == TL_GOVERNED_KEPT)
        return;
    say(choice->reason, sizeof choice->reason, how == TL_GOVERNED_UP ? "better" : "cheaper", &before,
        &choice->levels, choice->predicted_ms, pace->budget_ms);
    tl_debug("pace: %s", choice->reason);
}

/* As well as the settings ask. At rest nobody waits for the next frame. The first frame makes everything
 * anyway, and what it leaves behind, memory above all, makes other levels' first frames cheap. */
static void choose_whole(tl_pace *pace, const struct tl_budget *budget)
{
    const uint8_t best[TL_BUDGET_KNOBS_MAX] = {0};
    pace->choice.change_ms = budget->change(budget->context, best);
    pace->choice.predicted_ms = pace->choice.least_ms =
        budget->cost(budget->context, best) + pace->choice.change_ms;
    pace->choice.levels = (struct tl_levels){{0}};
}

struct tl_pace_choice tl_pace_choose(tl_pace *pace, tl_renderer *renderer, const tl_frame *frame,
                                     const struct tl_settings *settings)
{
    const struct tl_level_scope full = tl_level_scope_of(settings);
    for (int k = 0; k < TL_KNOB_COUNT; k++) {
        pace->level_counts[k] = tl_levels_count((enum tl_knob)k, &full);
        if (pace->choice.levels.of[k] >= pace->level_counts[k])
            pace->choice.levels.of[k] = (uint8_t)(pace->level_counts[k] - 1);
    }
    pace->rested = tl_renderer_is_moving(renderer, frame) ? 0 : pace->rested + 1;
    if (pace->budget_ms > 0 && pace->rested < REST_FRAMES)
        prepare_regions(pace, renderer, frame, &full);
    const struct coming coming = look_ahead(pace, renderer, frame, &full);
    const struct tl_budget budget = budget_of(pace, &coming);
    pace->choice.reason[0] = '\0';
    if (pace->budget_ms > 0 && pace->rested < REST_FRAMES && pace->cloth.runs > 0)
        choose_in_motion(pace, &budget);
    else
        choose_whole(pace, &budget);
    pace->choice.error = tl_levels_error(&pace->choice.levels, &full);
    struct tl_level_scope applied = tl_level_scope_at(&pace->choice.levels, &full);
    pace->cloth_work = cloth_work(&applied);
    pace->load = tl_renderer_load(renderer);
    if (pace->cloth.runs == 0)
        pace->choice.predicted_ms = (double)NAN;
    return pace->choice;
}

void tl_pace_steps(const tl_pace *pace, const tl_renderer *renderer, const tl_frame *frame,
                   const struct tl_settings *settings, struct tl_pace_step out[TL_KNOB_COUNT])
{
    const struct tl_level_scope full = tl_level_scope_of(settings);
    const struct coming coming = look_ahead(pace, renderer, frame, &full);
    uint8_t now[TL_BUDGET_KNOBS_MAX] = {0};
    memcpy(now, pace->choice.levels.of, sizeof pace->choice.levels.of);
    double ms = cost_of(&coming, now), error = error_of(&coming, now);
    for (int k = 0; k < TL_KNOB_COUNT; k++) {
        const struct tl_level_scope at = at_level(&coming, k, now[k]);
        out[k] = (struct tl_pace_step){.level = now[k],
                                       .level_count = pace->level_counts[k],
                                       .value = tl_level_value((enum tl_knob)k, &at),
                                       .ms = (double)NAN,
                                       .error = (double)NAN};
        if (now[k] == 0)
            continue;
        now[k]--;
        out[k].ms = cost_of(&coming, now) - ms;
        out[k].error = error - error_of(&coming, now);
        now[k]++;
    }
}

/* ---- What frames took ---- */

void tl_pace_learn(tl_pace *pace, const tl_plan *plan, double cloth_ms, double total_ms)
{
    double drawn_ms = 0;
    for (int i = 0; i < plan->count; i++)
        drawn_ms += plan->rows[i].took_ms;
    double predicted_ms = pace->choice.predicted_ms;
    tl_cost_learn(&pace->cloth, &pace->cloth_work, pace->load, cloth_ms);
    if (pace->is_preparing)
        return;
    tl_cost_learn(&pace->other, &any_work, pace->load, fmax(total_ms - cloth_ms - drawn_ms, 0));
    if (!isfinite(predicted_ms) || !(total_ms > 0))
        return;
    if (pace->budget_ms > 0 && pace->rested < REST_FRAMES)
        tl_governor_learn(&pace->governor, pace->budget_ms, total_ms);
    tl_debug("pace: predicted %.2f ms, took %.2f ms (cloth %.2f, drawing %.2f)", predicted_ms, total_ms,
             cloth_ms, drawn_ms);
}
