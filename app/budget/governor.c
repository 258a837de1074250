#include "app/budget/governor.h"

#include "config/base/log.h"
#include "config/base/memory.h"
#include "render/plan/budget.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The minimum of samples along the side of a pixel while ratios at vertices light them: the frame rate is
 * reduced rather than the samples below a quarter of the pixels, with which a garment can still be judged.
 * Scenes whose samples are expensive (open cloth, lamps) may go lower. */
#define SAMPLES_MIN 0.5f

/* After this many frames without a change the viewer is looking at a still image. */
#define REST_FRAMES 3

struct tl_quality_governor {
    double budget_ms;
    struct tl_governor state;
    int level_counts[TL_CONTROL_COUNT]; /* as the settings have them */
    struct tl_quality_choice choice;
    struct tl_cost_job cloth, other; /* all of a frame but drawing */
    double load;                     /* of the machine when the levels were chosen */
    bool is_preparing; /* the frame prepares regions: its time is not typical and is not learned */
    int rested;        /* frames without a change */
    uint64_t environment_revision;
};

tl_quality_governor *tl_quality_governor_create(double budget_ms)
{
    tl_quality_governor *governor = TL_NEW(tl_quality_governor);
    governor->budget_ms = budget_ms;
    governor->load = 1;
    governor->choice.predicted_ms = (double)NAN;
    return governor;
}

void tl_quality_governor_destroy(tl_quality_governor **handle)
{
    free(*handle);
    *handle = NULL;
}

void tl_quality_governor_set_budget(tl_quality_governor *governor, double budget_ms)
{
    governor->budget_ms = budget_ms;
}

/* ---- The cost of levels ---- */

static const struct tl_work any_work = {{1}};

struct coming {
    const tl_quality_governor *governor;
    const tl_renderer *renderer;
    struct tl_render_settings full;
    tl_bits running[2];                  /* jobs, at the levels of the last frame, by the level of RATIO */
    tl_bits started[TL_CONTROL_COUNT];   /* ... and with those that another level of a control starts */
    bool is_ready[TL_BUDGET_LEVELS_MAX]; /* levels of regions */
};

static double known_ms(const struct tl_cost_job *job, double load)
{
    return job->runs > 0 ? tl_cost_predict(job, &any_work, load) : 0;
}

static struct tl_quality levels_of(const uint8_t *of)
{
    struct tl_quality levels;
    memcpy(levels.of, of, sizeof levels.of);
    return levels;
}

/* Cost in ms of a frame that follows one at the same levels. */
static double cost_of(const void *context, const uint8_t *of)
{
    const struct coming *coming = context;
    const tl_quality_governor *governor = coming->governor;
    const struct tl_quality levels = levels_of(of);
    if (!coming->is_ready[levels.of[TL_CONTROL_REGIONS]])
        return INFINITY;
    const struct tl_render_settings applied = tl_quality_at(&levels, &coming->full);
    double load = tl_renderer_load(coming->renderer);
    return tl_renderer_predict_ms(coming->renderer, &applied, coming->running[levels.of[TL_CONTROL_RATIO]]) +
           known_ms(&governor->cloth, load) + known_ms(&governor->other, load);
}

/* Cost of changing to these levels, in ms, paid once: the jobs that run because a level differs from the last
 * frame's. */
static double change_of(const void *context, const uint8_t *of)
{
    const struct coming *coming = context;
    const tl_quality_governor *governor = coming->governor;
    const struct tl_quality levels = levels_of(of);
    tl_bits jobs = 0;
    for (int k = 0; k < TL_CONTROL_COUNT; k++)
        jobs |= of[k] != governor->choice.levels.of[k]
                    ? coming->started[k] & ~coming->running[of[TL_CONTROL_RATIO]]
                    : 0;
    if (!jobs)
        return 0;
    const struct tl_render_settings applied = tl_quality_at(&levels, &coming->full);
    return tl_renderer_predict_ms(coming->renderer, &applied, jobs);
}

static double error_of(const void *context, const uint8_t *of)
{
    const struct coming *coming = context;
    const struct tl_quality levels = levels_of(of);
    return tl_quality_error(&levels, &coming->full);
}

static struct tl_render_settings at_level(const struct coming *coming, int control, int level)
{
    struct tl_quality levels = coming->governor->choice.levels;
    levels.of[control] = (uint8_t)level;
    return tl_quality_at(&levels, &coming->full);
}

/* Finds the jobs that would run in the coming frame: at the levels of the last one, and when a control
 * changes its level, which runs jobs whose results would have been reused. */
static struct coming predict_coming(const tl_quality_governor *governor, const tl_renderer *renderer,
                                    const tl_frame *frame, const struct tl_render_settings *full)
{
    struct coming coming = {.governor = governor, .renderer = renderer, .full = *full};
    for (int level = 0; level < governor->level_counts[TL_CONTROL_RATIO]; level++) {
        struct tl_render_settings at = at_level(&coming, TL_CONTROL_RATIO, level);
        coming.running[level] = tl_renderer_predict_jobs(renderer, frame, &at);
    }
    for (int control = TL_CONTROL_RATIO + 1; control < TL_CONTROL_COUNT; control++) {
        int level = governor->choice.levels.of[control], other = level > 0 ? level - 1 : level + 1;
        struct tl_render_settings then = at_level(&coming, control, other);
        if (other < governor->level_counts[control])
            coming.started[control] = tl_renderer_predict_jobs(renderer, frame, &then);
    }
    for (int level = 0; level < governor->level_counts[TL_CONTROL_REGIONS]; level++) {
        struct tl_render_settings then = at_level(&coming, TL_CONTROL_REGIONS, level);
        coming.is_ready[level] = level == governor->choice.levels.of[TL_CONTROL_REGIONS] ||
                                 tl_renderer_has_regions(renderer, &then);
    }
    return coming;
}

static bool has_cheap_samples(const struct tl_quality_governor *governor, const struct coming *coming)
{
    return governor->level_counts[TL_CONTROL_RATIO] > 1 && coming->running[0] != coming->running[1];
}

static int count_scales(const struct tl_quality_governor *governor, const struct coming *coming)
{
    int count = 1;
    for (; count < governor->level_counts[TL_CONTROL_SCALE]; count++) {
        struct tl_quality levels = {.of[TL_CONTROL_SCALE] = (uint8_t)count};
        const struct tl_render_settings at = tl_quality_at(&levels, &coming->full);
        if (at.image.scale * (float)at.image.supersample < SAMPLES_MIN - 1e-3f)
            break;
    }
    return count;
}

static struct tl_budget budget_of(const tl_quality_governor *governor, const struct coming *coming)
{
    struct tl_budget budget = {.control_count = TL_CONTROL_COUNT,
                               .cost = cost_of,
                               .change = change_of,
                               .error = error_of,
                               .context = coming};
    memcpy(budget.level_counts, governor->level_counts, sizeof governor->level_counts);
    if (has_cheap_samples(governor, coming))
        budget.level_counts[TL_CONTROL_SCALE] = count_scales(governor, coming);
    return budget;
}

/* Prepares the regions of one level in each frame, the cheapest level first, once the environment stays. */
static void prepare_regions(tl_quality_governor *governor, tl_renderer *renderer, const tl_frame *frame,
                            const struct tl_render_settings *full)
{
    governor->is_preparing = false;
    bool stays = governor->environment_revision == frame->environment_revision;
    governor->environment_revision = frame->environment_revision;
    for (int level = governor->level_counts[TL_CONTROL_REGIONS] - 1; stays && level >= 0; level--) {
        struct tl_quality levels = {{0}};
        levels.of[TL_CONTROL_REGIONS] = (uint8_t)level;
        struct tl_render_settings then = tl_quality_at(&levels, full);
        if (tl_renderer_has_regions(renderer, &then))
            continue;
        tl_renderer_prepare_regions(renderer, &then);
        governor->is_preparing = true;
        return;
    }
}

bool tl_quality_governor_prepare(tl_quality_governor *governor, tl_renderer *renderer, const tl_frame *frame,
                                 const struct tl_settings *settings)
{
    const struct tl_render_settings full = tl_settings_render(settings);
    if (governor->budget_ms <= 0)
        return false;
    governor->level_counts[TL_CONTROL_REGIONS] = tl_quality_count(TL_CONTROL_REGIONS, &full);
    prepare_regions(governor, renderer, frame, &full);
    bool has_prepared = governor->is_preparing;
    governor->is_preparing = false;
    return has_prepared;
}

/* ---- The choice ---- */

static void describe(char *out, size_t size, const char *before, const struct tl_quality *old,
                     const struct tl_quality *new, double ms, double budget_ms)
{
    size_t length = (size_t)snprintf(out, size, "%s:", before);
    for (int k = 0; k < TL_CONTROL_COUNT && length < size; k++)
        if (old->of[k] != new->of[k])
            length += (size_t)snprintf(out + length, size - length, " %s %d to %d,", tl_control_names[k],
                                       old->of[k], new->of[k]);
    if (length < size)
        snprintf(out + length, size - length, " for %.1f of %.1f ms", ms, budget_ms);
}

/* The cost of the cheapest levels, which is looked for only where the choice exceeds the budget. */
static double min_of(const struct tl_budget *budget, double budget_ms, double predicted_ms)
{
    uint8_t levels[TL_BUDGET_CONTROLS_MAX] = {0};
    if (predicted_ms <= budget_ms)
        return predicted_ms;
    tl_budget_best(budget, budget_ms, INFINITY, levels);
    return budget->cost(budget->context, levels);
}

static void choose_in_motion(tl_quality_governor *governor, const struct tl_budget *budget)
{
    struct tl_quality_choice *choice = &governor->choice;
    struct tl_quality before = choice->levels;
    enum tl_governed how = tl_governor_choose(&governor->state, budget, governor->budget_ms);
    choice->lasting_ms = budget->cost(budget->context, governor->state.levels);
    choice->predicted_ms = choice->lasting_ms + budget->change(budget->context, governor->state.levels);
    choice->min_ms = min_of(budget, governor->budget_ms, choice->predicted_ms);
    memcpy(choice->levels.of, governor->state.levels, sizeof choice->levels.of);
    if (how == TL_GOVERNED_KEPT)
        return;
    describe(choice->reason, sizeof choice->reason, how == TL_GOVERNED_UP ? "better" : "cheaper", &before,
             &choice->levels, choice->predicted_ms, governor->budget_ms);
    tl_debug("governor: %s", choice->reason);
}

/* Level 0 of every control. At rest no next frame is waited for. The first frame of a motion within a budget,
 * of whose cost nothing is known, has ratios at vertices: they are the first to be saved. */
static void choose_whole(tl_quality_governor *governor, const struct tl_budget *budget)
{
    uint8_t best[TL_BUDGET_CONTROLS_MAX] = {0};
    bool is_hurried = governor->budget_ms > 0 && governor->rested < REST_FRAMES;
    best[TL_CONTROL_RATIO] = is_hurried && budget->level_counts[TL_CONTROL_RATIO] > 1;
    governor->choice.lasting_ms = budget->cost(budget->context, best);
    governor->choice.predicted_ms = governor->choice.min_ms =
        governor->choice.lasting_ms + budget->change(budget->context, best);
    governor->choice.levels = levels_of(best);
}

/* Whether the graphics card draws frames whose ratios are at vertices. */
static bool has_card(const struct coming *coming, const tl_frame *frame)
{
    const struct tl_render_settings at = at_level(coming, TL_CONTROL_RATIO, 1);
    return coming->governor->level_counts[TL_CONTROL_RATIO] > 1 &&
           tl_renderer_is_on_card(coming->renderer, frame, &at);
}

/* The levels of the graphics card, whatever the budget: it traces everything in every frame, and cheaper
 * levels would save none of its time. */
static void choose_card(tl_quality_governor *governor, const struct tl_budget *budget)
{
    uint8_t levels[TL_BUDGET_CONTROLS_MAX] = {[TL_CONTROL_RATIO] = 1};
    governor->choice.lasting_ms = governor->choice.predicted_ms = governor->choice.min_ms =
        budget->cost(budget->context, levels);
    governor->choice.levels = levels_of(levels);
}

struct tl_quality_choice tl_quality_governor_choose(tl_quality_governor *governor, tl_renderer *renderer,
                                                    const tl_frame *frame, const struct tl_settings *settings)
{
    const struct tl_render_settings full = tl_settings_render(settings);
    for (int k = 0; k < TL_CONTROL_COUNT; k++) {
        governor->level_counts[k] = tl_quality_count((enum tl_control)k, &full);
        if (governor->choice.levels.of[k] >= governor->level_counts[k])
            governor->choice.levels.of[k] = (uint8_t)(governor->level_counts[k] - 1);
    }
    governor->rested = tl_renderer_is_moving(renderer, frame) ? 0 : governor->rested + 1;
    if (governor->budget_ms > 0 && governor->rested < REST_FRAMES)
        prepare_regions(governor, renderer, frame, &full);
    const struct coming coming = predict_coming(governor, renderer, frame, &full);
    const struct tl_budget budget = budget_of(governor, &coming);
    governor->level_counts[TL_CONTROL_SCALE] = budget.level_counts[TL_CONTROL_SCALE];
    governor->choice.reason[0] = '\0';
    const bool is_hurried = governor->budget_ms > 0 && governor->rested < REST_FRAMES;
    if (is_hurried && has_card(&coming, frame))
        choose_card(governor, &budget);
    else if (is_hurried && governor->cloth.runs > 0)
        choose_in_motion(governor, &budget);
    else
        choose_whole(governor, &budget);
    governor->choice.error = tl_quality_error(&governor->choice.levels, &full);
    governor->load = tl_renderer_load(renderer);
    if (governor->cloth.runs == 0)
        governor->choice.predicted_ms = governor->choice.lasting_ms = (double)NAN;
    return governor->choice;
}

struct tl_quality_rest tl_quality_governor_rest(const tl_renderer *renderer, const tl_frame *frame,
                                                const struct tl_render_settings *settings)
{
    struct tl_quality_rest rest = {.is_slow = true};
    for (int level = 0; level < tl_quality_count(TL_CONTROL_RATIO, settings) && rest.is_slow; level++) {
        rest.levels.of[TL_CONTROL_RATIO] = (uint8_t)level;
        const struct tl_render_settings at = tl_quality_at(&rest.levels, settings);
        tl_bits jobs = tl_renderer_predict_jobs(renderer, frame, &at);
        rest.is_slow = tl_renderer_predict_ms(renderer, &at, jobs) > TL_REST_MS;
    }
    return rest;
}

void tl_quality_governor_steps(const tl_quality_governor *governor, const tl_renderer *renderer,
                               const tl_frame *frame, const struct tl_settings *settings,
                               struct tl_quality_step out[TL_CONTROL_COUNT])
{
    const struct tl_render_settings full = tl_settings_render(settings);
    const struct coming coming = predict_coming(governor, renderer, frame, &full);
    uint8_t now[TL_BUDGET_CONTROLS_MAX] = {0};
    memcpy(now, governor->choice.levels.of, sizeof governor->choice.levels.of);
    double ms = cost_of(&coming, now), error = error_of(&coming, now);
    for (int k = 0; k < TL_CONTROL_COUNT; k++) {
        const struct tl_render_settings at = at_level(&coming, k, now[k]);
        out[k] = (struct tl_quality_step){.level = now[k],
                                          .level_count = governor->level_counts[k],
                                          .value = tl_quality_value((enum tl_control)k, &at),
                                          .ms = (double)NAN,
                                          .error = (double)NAN};
        const int better = tl_quality_better((enum tl_control)k, &governor->choice.levels, &full);
        if (better < 0)
            continue;
        now[k] = (uint8_t)better;
        out[k].ms = cost_of(&coming, now) - ms;
        out[k].error = error - error_of(&coming, now);
        now[k] = (uint8_t)out[k].level;
    }
}

/* ---- Learning from the time that frames took ---- */

void tl_quality_governor_learn(tl_quality_governor *governor, const tl_plan *plan, double cloth_ms,
                               double total_ms)
{
    double drawn_ms = 0;
    for (int i = 0; i < plan->count; i++)
        drawn_ms += plan->rows[i].took_ms;
    double predicted_ms = governor->choice.predicted_ms;
    tl_cost_learn(&governor->cloth, &any_work, governor->load, cloth_ms);
    if (governor->is_preparing)
        return;
    tl_cost_learn(&governor->other, &any_work, governor->load, fmax(total_ms - cloth_ms - drawn_ms, 0));
    if (!isfinite(predicted_ms) || !(total_ms > 0))
        return;
    if (governor->budget_ms > 0 && governor->rested < REST_FRAMES)
        tl_governor_learn(&governor->state, governor->budget_ms, total_ms);
    tl_debug("governor: predicted %.2f ms, took %.2f ms (cloth %.2f, drawing %.2f)", predicted_ms, total_ms,
             cloth_ms, drawn_ms);
}
