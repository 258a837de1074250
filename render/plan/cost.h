/* What work costs, learned from what it took. Pure: no GL, no clock.
 *
 * A job's work is a few numbers, so many of which lie in each part of it: samples, rays, 1 for what is always
 * there. Its cost is the sum over the parts of work times ms a unit. At first the units cost what the job
 * table says, on some machine: only their ratios are believed. Each run then corrects them (a Kalman filter
 * whose state are the factors on the table's costs), so that levels that never ran are foretold from those
 * that did. What slows the whole machine down for a while, another program say, is one factor on all. */
#ifndef TOILE_RENDER_PLAN_COST_H
#define TOILE_RENDER_PLAN_COST_H

#include <stdbool.h>

#define TL_WORK_PARTS 4

/* Work times the table's ms a unit, part by part: ms on the machine of the table. */
struct tl_work {
    double ms[TL_WORK_PARTS];
};

double tl_work_sum(const struct tl_work *work);

struct tl_cost_job {
    int runs;
    double unit_ms; /* of work that the table knows nothing of: what the first runs took */
    double factor[TL_WORK_PARTS];
    double covariance[TL_WORK_PARTS][TL_WORK_PARTS];
};

/* NaN for a job that never ran, if the table knows nothing of it (no work in any part). */
double tl_cost_predict(const struct tl_cost_job *job, const struct tl_work *work, double load);
/* A run took `ms`, when the machine was slowed down by `load`. What no clock says (NaN, < 0) is left out. */
void tl_cost_learn(struct tl_cost_job *job, const struct tl_work *work, double load, double ms);

/* How much slower than usual the machine is; a load of 1, or an empty one: not at all. Follows frames'
 * measured over predicted cost within a few frames up, within some tens down. A single frame that was slow
 * is over when it is known, and is not followed. */
struct tl_machine_load {
    double factor;
    bool was_sudden; /* the last frame was much slower than those before */
};

double tl_machine_load_factor(const struct tl_machine_load *load);
void tl_machine_load_follow(struct tl_machine_load *load, double predicted_ms, double took_ms);

#endif
