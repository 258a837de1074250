/* Levels within a budget. Pure: no GL, no clock.
 *
 * A knob has levels, of which the first is what is asked for. The levels of all knobs make a few thousand
 * combinations at most, so all of them are looked at: the best one within the budget is found whenever there
 * is one, and a larger budget never gives a larger error.
 *
 * A governor carries the choice from frame to frame. It goes down at once when a frame would be too dear, and
 * up only for what is better by a margin, fits with room to spare, makes no frame late by itself, and some
 * frames after the last change: longer each time a step up had to be taken back. */
#ifndef TOILE_RENDER_PLAN_BUDGET_H
#define TOILE_RENDER_PLAN_BUDGET_H

#include <stdbool.h>
#include <stdint.h>

#define TL_BUDGET_KNOBS_MAX  8
#define TL_BUDGET_LEVELS_MAX 14

/* Levels come one a knob, in arrays of TL_BUDGET_KNOBS_MAX. */
typedef double (*tl_budget_figure)(const void *context, const uint8_t *levels);

struct tl_budget {
    int knob_count;
    int level_counts[TL_BUDGET_KNOBS_MAX]; /* at least 1 */
    tl_budget_figure cost;                 /* ms of a frame at these levels */
    tl_budget_figure change;               /* ms more of the first such frame; 0 at the levels that are */
    tl_budget_figure error;                /* of a frame at these levels, in any unit; >= 0 */
    const void *context;
};

/* The least error at a cost of at most `limit_ms`, and of at most `first_ms` in the first frame; then the
 * least cost. Where nothing is as cheap as that, the cheapest, and false. */
bool tl_budget_best(const struct tl_budget *budget, double limit_ms, double first_ms, uint8_t *levels);

struct tl_governor {
    uint8_t levels[TL_BUDGET_KNOBS_MAX];
    int knob_count;   /* that they were chosen for; 0: nothing was chosen yet */
    int settled;      /* frames since the last change */
    int patience;     /* frames to wait before the next step up */
    bool is_trial;    /* the last change was one up */
    bool was_over;    /* the last frame was: one may be, a second says that the costs are wrong */
    double budget_ms; /* that the share was begun for */
    double share;     /* of the budget that is planned with: the rest is for what cannot be foreseen */
    double panic;     /* factor under the budget after frames that were over it; 1: calm */
};

enum tl_governed { TL_GOVERNED_KEPT, TL_GOVERNED_DOWN, TL_GOVERNED_UP };

/* Chooses governor->levels of the next frame. */
enum tl_governed tl_governor_choose(struct tl_governor *governor, const struct tl_budget *budget,
                                    double budget_ms);
/* What the frame took that was chosen last. */
void tl_governor_learn(struct tl_governor *governor, double budget_ms, double took_ms);

#endif
