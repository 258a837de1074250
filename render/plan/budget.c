#include "render/plan/budget.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define WAIT_MIN 8    /* frames */
#define WAIT_NEW 2    /* ... while the governor is new: its first choices follow from costs of first runs */
#define NEW      12   /* frames for which it is new */
#define WAIT_MAX 32   /* also the delay until the end of a load is noticed */
#define GAIN_MIN 0.95 /* a step up leaves at most this much of the error */
#define HEADROOM 0.94 /* ... and costs at most this much of what may be planned with */

/* One frame in a hundred may exceed the budget by the factor 1.1. The share of the budget that plans use is
 * controlled to that end: each such frame lowers it by a step, each other frame raises it by so little that
 * both balance at one such frame in two hundred.
 *
 * Initially 12 % of the budget and 6 ms are left for unpredicted time: in 15 flights of 600 frames at 33, 50
 * and 100 ms, on two cores, one frame in a hundred took 5 to 10, 7 to 9 and 13 to 20 ms more than predicted.
 * The 6 ms are work of other processes and do not depend on the budget: a trace of the scheduler showed a
 * kernel thread that scans for idle memory occupy one of the two cores for 25 to 33 ms every 5 s. */
#define OVER          1.1
#define OVER_RATE     0.005
#define UNSEEN_SHARE  0.12
#define UNSEEN_MS     6.0
#define SHARE_STEP    0.03
#define SHARE_MIN     0.75
#define SHARE_MAX     0.96
#define BACKOFF_STEP  1.12
#define BACKOFF_MAX   1.6
#define BACKOFF_DECAY 0.9

/* Advances to the next combination, the last control fastest; false after the last one. */
static bool next_levels(const struct tl_budget *budget, uint8_t *levels)
{
    for (int k = budget->control_count - 1; k >= 0; k--) {
        if (++levels[k] < budget->level_counts[k])
            return true;
        levels[k] = 0;
    }
    return false;
}

struct candidate {
    uint8_t levels[TL_BUDGET_CONTROLS_MAX];
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

static struct candidate find_best(const struct tl_budget *budget, double limit_ms, double first_ms,
                                  double *cheapest_ms)
{
    struct candidate best = {.cost = INFINITY, .error = INFINITY}, each = {0};
    *cheapest_ms = INFINITY;
    do {
        each.cost = budget->cost(budget->context, each.levels);
        each.error = budget->error(budget->context, each.levels);
        each.fits =
            each.cost <= limit_ms && each.cost + budget->change(budget->context, each.levels) <= first_ms;
        if (is_better(&each, &best))
            best = each;
        *cheapest_ms = fmin(*cheapest_ms, each.cost);
    } while (next_levels(budget, each.levels));
    return best;
}

bool tl_budget_best(const struct tl_budget *budget, double limit_ms, double first_ms, uint8_t *levels)
{
    assert(budget->control_count > 0 && budget->control_count <= TL_BUDGET_CONTROLS_MAX);
    double cheapest_ms, unused;
    struct candidate best = find_best(budget, limit_ms, first_ms, &cheapest_ms);
    bool fits = best.fits;
    if (!fits || TL_BUDGET_SLACK * cheapest_ms > limit_ms)
        best = find_best(budget, fmax(limit_ms, TL_BUDGET_SLACK * cheapest_ms), fits ? first_ms : INFINITY,
                         &unused);
    memcpy(levels, best.levels, sizeof best.levels);
    return fits;
}

static void begin(struct tl_governor *governor, const struct tl_budget *budget)
{
    *governor = (struct tl_governor){.control_count = budget->control_count, .wait = WAIT_MIN, .backoff = 1};
}

static void begin_budget(struct tl_governor *governor, double budget_ms)
{
    if (governor->budget_ms == budget_ms)
        return;
    governor->budget_ms = budget_ms;
    governor->share = fmin(fmax(OVER - UNSEEN_SHARE - UNSEEN_MS / budget_ms, SHARE_MIN), SHARE_MAX);
}

/* Limits levels to those that exist: a control that the scene does not use has one level only. */
static bool keep_within(struct tl_governor *governor, const struct tl_budget *budget)
{
    bool was_within = true;
    for (int k = 0; k < budget->control_count; k++)
        if (governor->levels[k] >= budget->level_counts[k]) {
            governor->levels[k] = (uint8_t)(budget->level_counts[k] - 1);
            was_within = false;
        }
    return was_within;
}

static enum tl_governed change(struct tl_governor *governor, const uint8_t levels[TL_BUDGET_CONTROLS_MAX],
                               enum tl_governed how)
{
    if (memcmp(governor->levels, levels, sizeof governor->levels) == 0)
        return TL_GOVERNED_KEPT;
    memcpy(governor->levels, levels, sizeof governor->levels);
    if (how == TL_GOVERNED_DOWN && governor->is_trial && governor->age >= NEW &&
        governor->settled < 2 * governor->wait)
        governor->wait = 2 * governor->wait < WAIT_MAX ? 2 * governor->wait : WAIT_MAX;
    governor->is_trial = how == TL_GOVERNED_UP;
    governor->settled = 0;
    return how;
}

enum tl_governed tl_governor_choose(struct tl_governor *governor, const struct tl_budget *budget,
                                    double budget_ms)
{
    uint8_t best[TL_BUDGET_CONTROLS_MAX];
    bool is_first = governor->control_count != budget->control_count;
    if (is_first)
        begin(governor, budget);
    begin_budget(governor, budget_ms);
    bool within = keep_within(governor, budget);
    double limit_ms = budget_ms * governor->share / governor->backoff;
    governor->settled++;
    governor->age += governor->age < NEW;
    double cost = budget->cost(budget->context, governor->levels);
    if (is_first || !within || cost > limit_ms) {
        if (is_first || !tl_budget_best(budget, HEADROOM * limit_ms, OVER * budget_ms, best))
            tl_budget_best(budget, is_first ? limit_ms : HEADROOM * limit_ms, INFINITY, best);
        return change(governor, best, TL_GOVERNED_DOWN);
    }
    if (governor->settled > 4 * WAIT_MAX)
        governor->wait = WAIT_MIN;
    if (governor->settled < (governor->age < NEW ? WAIT_NEW : governor->wait) || governor->backoff > 1.01)
        return TL_GOVERNED_KEPT;
    bool fits = tl_budget_best(budget, HEADROOM * limit_ms, OVER * budget_ms, best);
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
    /* In the first frames jobs do what is done once: their time predicts nothing of the frames that follow.
     */
    bool is_over = took_ms > OVER * budget_ms && governor->age >= NEW;
    if (!is_over) {
        governor->share = fmin(governor->share + SHARE_STEP * OVER_RATE / (1 - OVER_RATE), SHARE_MAX);
        governor->backoff = 1 + BACKOFF_DECAY * (governor->backoff - 1);
    } else if (!governor->was_over) {
        governor->share = fmax(governor->share - SHARE_STEP, SHARE_MIN);
    } else {
        governor->backoff = fmin(BACKOFF_STEP * governor->backoff, BACKOFF_MAX);
    }
    governor->was_over = is_over;
}
