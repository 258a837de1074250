/* The plan of a frame: which jobs of the table run, at which level, and why. Pure: no GL, no clock.
 *
 * plan = f(jobs, what changed, what the scene requires, what is wanted). A job is dropped when the scene does
 * not require it or no job reads its results, reused when nothing that it reads has changed, and run
 * otherwise. */
#ifndef TOILE_RENDER_PLAN_PLAN_H
#define TOILE_RENDER_PLAN_PLAN_H

#include "config/base/error.h"
#include "render/plan/cost.h"

#include <stddef.h>
#include <stdint.h>

#define TL_JOBS_MAX       40
#define TL_JOB_LEVELS_MAX 6

typedef uint64_t tl_bits; /* a set of resources or facts */

enum tl_job_action { TL_JOB_RUN, TL_JOB_REUSE, TL_JOB_DROP };
extern const char *const tl_job_action_names[]; /* run reuse drop */

typedef struct tl_job {
    const char *name; /* "regions", "maps", "light" ... */
    const char *what; /* one line for people */
    tl_bits reads;    /* bits of resources; a resource that no job writes is an input of the frame */
    tl_bits writes;
    tl_bits requires_scene;                /* bits of scene facts that must all hold, else dropped */
    const char *levels[TL_JOB_LEVELS_MAX]; /* names, cost grows and error falls; at least one */
    bool (*run)(void *context, int level, tl_error *error);
    struct tl_work (*work)(const void *seen); /* of a frame to come; NULL: always the same */
} tl_job;

struct tl_plan_input {
    tl_bits changed;                     /* resources (inputs of the frame) that differ from the last frame */
    tl_bits valid;                       /* resources that an earlier frame left behind */
    tl_bits scene;                       /* facts about the scene */
    tl_bits wanted;                      /* resources that the caller reads afterwards */
    const char *const *scene_fact_names; /* by bit, for reasons */
    const char *const *resource_names;   /* by bit */
};

struct tl_plan_row {
    const char *name;
    enum tl_job_action action;
    int level;
    char reason[120];
    double predicted_ms; /* by the cost model; NaN while unknown, 0 for what does not run */
    double took_ms;      /* once carried out; 0 for what did not run */
    double work_ms;      /* ... the same by the table's costs, on the table's machine; 0 where it has none */
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
