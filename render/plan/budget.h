/* Chooses levels within a time budget. Pure: no GL, no clock.
 *
 * A control has levels, of which level 0 is the setting that the user asked for. All controls together have a
 * few thousand combinations at most, and all of them are evaluated: the best one within the budget is found
 * if there is any, and a larger budget never gives a larger error.
 *
 * A governor carries the choice from frame to frame. It steps down at once when a frame would exceed the
 * budget. It steps up only if the error falls by a margin, the cost leaves headroom, the change itself makes
 * no frame late, and some frames have passed since the last change: more of them each time a step up had to
 * be undone. */
#ifndef TOILE_RENDER_PLAN_BUDGET_H
#define TOILE_RENDER_PLAN_BUDGET_H

#include <stdbool.h>
#include <stdint.h>

#define TL_BUDGET_CONTROLS_MAX 8
#define TL_BUDGET_LEVELS_MAX   14

/* `levels` has one level a control, in an array of TL_BUDGET_CONTROLS_MAX. */
typedef double (*tl_budget_figure)(const void *context, const uint8_t *levels);

struct tl_budget {
    int control_count;
    int level_counts[TL_BUDGET_CONTROLS_MAX]; /* at least 1 */
    tl_budget_figure cost;                    /* ms of a frame at these levels */
    tl_budget_figure change; /* additional ms of the first such frame; 0 at the current levels */
    tl_budget_figure error;  /* of a frame at these levels, in any unit; >= 0 */
    const void *context;
};

/* Finds the smallest error at a cost of at most `limit_ms`, and of at most `first_ms` in the first frame;
 * among equal errors the smallest cost. Where the cheapest combination nearly takes the limit or more, up to
 * TL_BUDGET_SLACK times its cost is allowed instead: much error is not accepted for little time. False when
 * even the cheapest exceeds the limits. */
#define TL_BUDGET_SLACK 1.2
bool tl_budget_best(const struct tl_budget *budget, double limit_ms, double first_ms, uint8_t *levels);

struct tl_governor {
    uint8_t levels[TL_BUDGET_CONTROLS_MAX];
    int control_count; /* number of controls at the last choice; 0: no choice yet */
    int settled;       /* frames since the last change */
    int wait;          /* frames to wait before the next step up */
    int age;           /* choices so far, up to those after which it is no longer new */
    bool is_trial;     /* the last change was one up */
    bool was_over;     /* the last frame exceeded the budget; a second one in a row means wrong costs */
    double budget_ms;  /* for which `share` was initialised */
    double share;      /* fraction of the budget that plans may use; the rest is for unpredicted time */
    double backoff;    /* divisor of the budget after repeated frames over it; 1: none */
};

enum tl_governed { TL_GOVERNED_KEPT, TL_GOVERNED_DOWN, TL_GOVERNED_UP };

/* Chooses governor->levels of the next frame. */
enum tl_governed tl_governor_choose(struct tl_governor *governor, const struct tl_budget *budget,
                                    double budget_ms);
/* Reports the measured time of the frame that was chosen last. */
void tl_governor_learn(struct tl_governor *governor, double budget_ms, double took_ms);

#endif
