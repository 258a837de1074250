/* The plan of a frame: which jobs of the table run, at which level, and why. Pure: no GL, no clock.
 *
 * plan = f(jobs, what changed, what the scene requires, what is wanted). A job is dropped when the scene does
 * not require it or no job reads its results, reused when nothing that it reads has changed, and run
 * otherwise.
 *
 * Lifetime: plans hold no pointers but to names, which must be constants. Threads: any. */
#ifndef TOILE_RENDER_PLAN_PLAN_H
#define TOILE_RENDER_PLAN_PLAN_H

#include "config/base/error.h"
#include "render/plan/cost.h"

#include <stddef.h>
#include <stdint.h>

#define TL_JOBS_MAX       48
#define TL_JOB_LEVELS_MAX 6

typedef unsigned __int128 tl_bits; /* a set of resources or facts */

enum tl_job_action { TL_JOB_RUN, TL_JOB_REUSE, TL_JOB_DROP };
extern const char *const tl_job_action_names[]; /* run reuse drop */

typedef struct tl_job {
    /* "regions", "maps", "light" ..., and one line for people. */
    const char *name;
    const char *what;
    /* Resources by bit. One that no job writes is an input of the frame; 0: the job runs once. */
    tl_bits reads;
    tl_bits writes;
    /* Facts about the scene, by bit, that must all hold, else the job is dropped; 0: it is always allowed. */
    tl_bits requires_scene;
    /* Names: cost grows and error falls from each to the next. At least one; NULL ends them. */
    const char *levels[TL_JOB_LEVELS_MAX];
    /* False, with `error` set, when the job failed. */
    bool (*run)(void *context, int level, tl_error *error);
} tl_job;

struct tl_plan_input {
    /* Inputs of the frame that differ from the last one. */
    tl_bits changed;
    /* Resources that an earlier frame left behind; 0: there was none. */
    tl_bits valid;
    /* Facts about the scene. */
    tl_bits scene;
    /* Resources that the caller reads afterwards; 0: every job is dropped. */
    tl_bits wanted;
    /* Names by bit, for reasons; NULL: "?". */
    const char *const *scene_fact_names;
    const char *const *resource_names;
};

struct tl_plan_row {
    const char *name;
    enum tl_job_action action;
    int level;
    /* The reason, for people: "changed: camera". */
    char reason[120];
    /* Time by the cost model; NaN while it is unknown, 0 for what does not run. */
    double predicted_ms;
    /* Once carried out; 0 for what did not run. When it began is by tl_clock_s; of the graphics card's jobs
     * it is as if the card began the first when that was queued. */
    double took_ms, began_s;
    /* The same by the table's costs, on the table's machine; 0 where it has none. */
    double work_ms;
};

typedef struct tl_plan {
    int count;
    struct tl_plan_row rows[TL_JOBS_MAX]; /* in the table's order */
} tl_plan;

/* False when the table is not in a possible order: a job reads what only a later one writes. */
bool tl_jobs_check(const tl_job *jobs, int count, tl_error *error);
/* `predicted_ms` by job, or NULL. */
void tl_plan_make(const tl_job *jobs, int count, const struct tl_plan_input *input,
                  const double *predicted_ms, tl_plan *out);

/* The resources that are up to date once the plan has been carried out: the next frame's `valid`. What a job
 * wrote earlier goes stale when the job is dropped while something that it reads changes. */
tl_bits tl_plan_valid_after(const tl_job *jobs, int count, const struct tl_plan_input *input,
                            const tl_plan *plan);

#endif
