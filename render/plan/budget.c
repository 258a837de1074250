#include "render/plan/budget.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define PATIENCE_MIN 8    /* frames */
#define PATIENCE_MAX 32   /* within which a load that has gone is found to be gone */
#define GAIN_MIN     0.95 /* a step up leaves at most this much of the error */
#define ROOM         0.94 /* ... and costs at most this much of what may be planned with */

/* A frame may be over by 1.1 once in a hundred. The share of the budget that is planned with is led there:
 * down a step with each such frame, and up by so little with each other that they balance at one in two
 * hundred.
 *
 * It begins where the budget's own twelve hundredths and 6 ms are left for what cannot be foreseen: in 15
 * flights of 600 frames at 33, 50 and 100 ms, two cores, one frame in a hundred took 5 to 10, 7 to 9 and 13
 * to 20 ms more than predicted. The 6 ms are others' work, whatever the budget: a trace of the scheduler
 * showed a kernel thread that looks for idle memory hold one of the two cores for 25 to 33 ms every 5 s. */
#define OVER         1.1
#define OVER_RATE    0.005
#define UNSEEN_SHARE 0.12
#define UNSEEN_MS    6.0
#define SHARE_STEP   0.03
#define SHARE_MIN    0.75
#define SHARE_MAX    0.96
#define PANIC_STEP   1.12
#define PANIC_MAX    1.6
#define PANIC_DECAY  0.9

/* The next combination, counting with the last knob first; false after the last one. */
static bool next_levels(const struct tl_budget *budget, uint8_t *levels)
{
    for (int k = budget->knob_count - 1; k >= 0; k--) {
        if (++levels[k] < budget->level_counts[k])
            return true;
        levels[k] = 0;
    }
    return false;
}

struct candidate {
    uint8_t levels[TL_BUDGET_KNOBS_MAX];
    double cost, error;
    bool fits;
};

static bool is_better(const struct candidate *a, const struct candidate *b)
{
    if (a->fits != b->fits)
        return a->fits;
    if (!a->fits)
        return a->cost < b->cost;
    return a->error < b->error || (a->error == b->error && a->cost < b->cost);
}

bool tl_budget_best(const struct tl_budget *budget, double limit_ms, double first_ms, uint8_t *levels)
{
    assert(budget->knob_count > 0 && budget->knob_count <= TL_BUDGET_KNOBS_MAX);
    struct candidate best = {.cost = INFINITY, .error = INFINITY}, each = {0};
    do {
        each.cost = budget->cost(budget->context, each.levels);
        each.error = budget->error(budget->context, each.levels);
        each.fits =
            each.cost <= limit_ms && each.cost + budget->change(budget->context, each.levels) <= first_ms;
        if (is_better(&each, &best))
            best = each;
    } while (next_levels(budget, each.levels));
    memcpy(levels, best.levels, sizeof best.levels);
    return best.fits;
}

static void begin(struct tl_governor *governor, const struct tl_budget *budget)
{
    *governor = (struct tl_governor){.knob_count = budget->knob_count, .patience = PATIENCE_MIN, .panic = 1};
}

static void begin_budget(struct tl_governor *governor, double budget_ms)
{
    if (governor->budget_ms == budget_ms)
        return;
    governor->budget_ms = budget_ms;
    governor->share = fmin(fmax(OVER - UNSEEN_SHARE - UNSEEN_MS / budget_ms, SHARE_MIN), SHARE_MAX);
}

/* What the scene no longer asks for has one level only. */
static bool keep_within(struct tl_governor *governor, const struct tl_budget *budget)
{
    bool was_within = true;
    for (int k = 0; k < budget->knob_count; k++)
        if (governor->levels[k] >= budget->level_counts[k]) {
            governor->levels[k] = (uint8_t)(budget->level_counts[k] - 1);
            was_within = false;
        }
    return was_within;
}

static enum tl_governed change(struct tl_governor *governor, const uint8_t levels[TL_BUDGET_KNOBS_MAX],
                               enum tl_governed how)
{
    if (memcmp(governor->levels, levels, sizeof governor->levels) == 0)
        return TL_GOVERNED_KEPT;
    memcpy(governor->levels, levels, sizeof governor->levels);
    if (how == TL_GOVERNED_DOWN && governor->is_trial && governor->settled < 2 * governor->patience)
        governor->patience = 2 * governor->patience < PATIENCE_MAX ? 2 * governor->patience : PATIENCE_MAX;
    governor->is_trial = how == TL_GOVERNED_UP;
    governor->settled = 0;
    return how;
}

enum tl_governed tl_governor_choose(struct tl_governor *governor, const struct tl_budget *budget,
                                    double budget_ms)
{
    uint8_t best[TL_BUDGET_KNOBS_MAX];
    bool is_first = governor->knob_count != budget->knob_count;
    if (is_first)
        begin(governor, budget);
    begin_budget(governor, budget_ms);
    bool within = keep_within(governor, budget);
    double limit_ms = budget_ms * governor->share / governor->panic;
    governor->settled++;
    double cost = budget->cost(budget->context, governor->levels);
    if (is_first || !within || cost > limit_ms) {
        if (is_first || !tl_budget_best(budget, ROOM * limit_ms, OVER * budget_ms, best))
            tl_budget_best(budget, is_first ? limit_ms : ROOM * limit_ms, INFINITY, best);
        return change(governor, best, TL_GOVERNED_DOWN);
    }
    if (governor->settled > 4 * PATIENCE_MAX)
        governor->patience = PATIENCE_MIN;
    if (governor->settled < governor->patience || governor->panic > 1.01)
        return TL_GOVERNED_KEPT;
    bool fits = tl_budget_best(budget, ROOM * limit_ms, OVER * budget_ms, best);
    double now = budget->error(budget->context, governor->levels);
    double then = budget->error(budget->context, best);
    if (!fits || then >= now || (then > 0 && then > GAIN_MIN * now))
        return TL_GOVERNED_KEPT;
    return change(governor, best, TL_GOVERNED_UP);
}

void tl_governor_learn(struct tl_governor *governor, double budget_ms, double took_ms)
{
    if (!isfinite(took_ms))
        return;
    bool is_over = took_ms > OVER * budget_ms;
    if (!is_over) {
        governor->share = fmin(governor->share + SHARE_STEP * OVER_RATE / (1 - OVER_RATE), SHARE_MAX);
        governor->panic = 1 + PANIC_DECAY * (governor->panic - 1);
    } else if (!governor->was_over) {
        governor->share = fmax(governor->share - SHARE_STEP, SHARE_MIN);
    } else {
        governor->panic = fmin(PANIC_STEP * governor->panic, PANIC_MAX);
    }
    governor->was_over = is_over;
}
