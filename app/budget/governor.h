/* The governor keeps frames within a time budget. Before each frame it chooses the level of every quality
 * control from what similar frames have cost; after it, it learns what the frame took.
 *
 *     choose -> settings of this frame -> cloth, draw -> learn
 *
 * The choice itself is render/plan/budget.h, pure; here controls are bound to settings and costs to jobs.
 * Only tl_quality_governor_choose depends on the clock: recorded levels, applied to the same settings again,
 * give the same images to the bit.
 *
 * Units: milliseconds of wall time, on the machine as loaded as it is. Errors: none of the functions fails.
 * Lifetime: the caller owns a governor from create to destroy; results are values. Threads: one at a time for
 * each governor. */
#ifndef TOILE_APP_BUDGET_GOVERNOR_H
#define TOILE_APP_BUDGET_GOVERNOR_H

#include "app/budget/quality.h"
#include "render/renderer.h"

struct tl_quality_choice {
    struct tl_quality levels;
    double predicted_ms; /* cloth and drawing; NaN before the first frame */
    double lasting_ms;   /* ... without what the change to these levels costs once; NaN before, too */
    double min_ms; /* of the cheapest levels that may be chosen, where predicted_ms exceeds the budget; else
                      predicted_ms */
    double error;  /* estimated; what the levels add to that of the settings (quality.h) */
    char reason[120]; /* for people: what was reduced or restored, and why; "" when nothing changed */
};

typedef struct tl_quality_governor tl_quality_governor;

tl_quality_governor *
tl_quality_governor_create(double budget_ms); /* 0: no budget: always level 0, but it predicts */
void tl_quality_governor_destroy(tl_quality_governor **handle);
void tl_quality_governor_set_budget(tl_quality_governor *governor, double budget_ms);

/* Chooses the levels of the coming frame. `frame` is that frame as far as it is known: the last one drawn
 * with the coming camera, so that the end of a rest is noticed; or the first frame. `settings` are those of
 * full quality. The first frame, and frames at rest (after three frames in which nothing moved), are at level
 * 0 whatever the budget. In the first frames after a change of environment the renderer prepares the regions
 * of other levels, one level a frame. */
struct tl_quality_choice tl_quality_governor_choose(tl_quality_governor *governor, tl_renderer *renderer,
                                                    const tl_frame *frame,
                                                    const struct tl_settings *settings);

/* Prepares the regions of one more level that a coming motion may ask for; for moments in which nobody waits,
 * so that the first frames of the motion need not. `frame` and `settings` are those of the image at rest.
 * Returns false when all are prepared, there is no budget, or the environment has only just changed. */
bool tl_quality_governor_prepare(tl_quality_governor *governor, tl_renderer *renderer, const tl_frame *frame,
                                 const struct tl_settings *settings);

/* Returns the levels of an image at rest, for which nobody waits but the next gesture: full quality; with
 * ratios at vertices where a frame would hold that gesture up for longer than TL_REST_MS. */
#define TL_REST_MS 300
struct tl_quality_rest {
    struct tl_quality levels;
    bool is_slow; /* even so */
};
struct tl_quality_rest tl_quality_governor_rest(const tl_renderer *renderer, const tl_frame *frame,
                                                const struct tl_render_settings *settings);

/* Learns from a frame drawn at the levels chosen last: its plan with took_ms, the time of the cloth, and the
 * total time from the choice to the finished image. */
void tl_quality_governor_learn(tl_quality_governor *governor, const tl_plan *plan, double cloth_ms,
                               double total_ms);

/* For each control, what its next better level would change from the levels chosen last. */
struct tl_quality_step {
    int level, level_count;
    double value;     /* of the setting at this level: regions, steps, scale */
    double ms, error; /* additional time, and error removed (> 0); NaN where no level is better */
};
void tl_quality_governor_steps(const tl_quality_governor *governor, const tl_renderer *renderer,
                               const tl_frame *frame, const struct tl_settings *settings,
                               struct tl_quality_step out[TL_CONTROL_COUNT]);

#endif
