/* Keeps frames within a time budget: before each frame it chooses the level of every knob from what frames
 * like it have cost, afterwards it learns what this one took.
 *
 *     choose -> settings of this frame -> cloth, draw -> learn
 *
 * The choice itself is render/plan/budget.h, pure; here knobs are bound to settings and costs to jobs. A
 * record of levels, applied to the same settings again, gives the same images bit by bit: only tl_pace_choose
 * looks at what the clock said. Times: milliseconds on the wall, of the machine as it is. Threads: one at a
 * time. */
#ifndef TOILE_APP_BUDGET_GOVERNOR_H
#define TOILE_APP_BUDGET_GOVERNOR_H

#include "app/budget/levels.h"
#include "render/renderer.h"

struct tl_pace_choice {
    struct tl_levels levels;
    double predicted_ms; /* cloth and drawing; NaN while nothing is known */
    double change_ms;    /* of these, what changing to the levels takes, once */
    double least_ms;     /* of the cheapest levels, where that is more than the budget; else predicted_ms */
    double error;        /* estimated, mean FLIP that the levels add to that of the settings */
    char reason[120];    /* for people: what was shed or taken back, and why; "" when nothing changed */
};

typedef struct tl_pace tl_pace;

tl_pace *tl_pace_create(double budget_ms); /* 0: no budget, level 0 always, but it predicts */
void tl_pace_destroy(tl_pace **handle);
void tl_pace_set_budget(tl_pace *pace, double budget_ms);

/* `frame` is the coming one as far as it is known: the last one drawn, with the camera that will be there, so
 * that the end of a rest is seen; or the first. `settings` are those of full quality. At rest (three frames
 * in which nothing moved) everything goes into the image: level 0, whatever the budget; and so is the first.
 * In the first frames after an environment came, the renderer makes the regions of other levels ready, one
 * level a frame. */
struct tl_pace_choice tl_pace_choose(tl_pace *pace, tl_renderer *renderer, const tl_frame *frame,
                                     const struct tl_settings *settings);

/* What a frame took that was drawn at the levels chosen last: its plan with took_ms, the cloth's part, and
 * the whole from the choice to the finished image. */
void tl_pace_learn(tl_pace *pace, const tl_plan *plan, double cloth_ms, double total_ms);

/* What the next better level of a knob would change, from the levels chosen last. */
struct tl_pace_step {
    int level, level_count;
    double value;     /* of the setting at this level: regions, steps, substeps a frame, scale */
    double ms, error; /* dearer by so much, in error by so much less; NaN at level 0 */
};
void tl_pace_steps(const tl_pace *pace, const tl_renderer *renderer, const tl_frame *frame,
                   const struct tl_settings *settings, struct tl_pace_step out[TL_KNOB_COUNT]);

#endif
