/* The cost of work, learned from measured times. Pure: no GL, no clock.
 *
 * A job's work has a few parts, each with a number of units: samples, rays, 1 for the constant part. Its cost
 * is the sum over the parts of units times ms a unit. The job table gives initial costs, measured on some
 * machine: only their ratios are trusted. Each run then corrects them (a Kalman filter whose state is the
 * factors on the table's costs), so that the cost of levels that never ran is predicted from those that did.
 * A slowdown of the whole machine, by another program for example, is one factor on all jobs. */
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
    double unit_ms; /* for jobs without work in the table: time of the first runs */
    double factor[TL_WORK_PARTS];
    double covariance[TL_WORK_PARTS][TL_WORK_PARTS];
};

/* Predicted ms. NaN for a job that never ran and has no work in the table. */
double tl_cost_predict(const struct tl_cost_job *job, const struct tl_work *work, double load);

/* The factor by which this machine is slower than the table's, by jobs that ran and their work; jobs that
 * never ran, or have no work in the table, are left out. 1 when none is left. */
double tl_cost_slowness(const struct tl_cost_job *jobs, const struct tl_work *work, int count);
/* tl_cost_predict for a frame to come. A job of fewer than TL_COST_KNOWN runs is not expected to take longer
 * than the table says for a machine of this slowness: its first runs also did what is done once. */
#define TL_COST_KNOWN 3
double tl_cost_expect(const struct tl_cost_job *job, const struct tl_work *work, double load,
                      double slowness);

/* Learns from a run that took `ms` while the machine was slowed down by `load`. Ignores times that are NaN or
 * negative. */
void tl_cost_learn(struct tl_cost_job *job, const struct tl_work *work, double load, double ms);

/* The factor by which the machine is slower than usual: 1, or an empty struct, for not at all. Follows the
 * ratio of measured to predicted frame times, upwards within a few frames, downwards within some tens. A
 * single slow frame is ignored: it is over when it is measured. */
struct tl_machine_load {
    double factor;
    bool was_sudden; /* the last frame was much slower than those before */
};

double tl_machine_load_factor(const struct tl_machine_load *load);
void tl_machine_load_follow(struct tl_machine_load *load, double predicted_ms, double took_ms);

#endif
