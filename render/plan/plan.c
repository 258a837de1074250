#include "render/plan/plan.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

const char *const tl_job_action_names[] = {"run", "reuse", "drop", NULL};

bool tl_jobs_check(const tl_job *jobs, int count, tl_error *error)
{
    if (count < 0 || count > TL_JOBS_MAX)
        return tl_fail(error, TL_USAGE, "job table: %d jobs: at most %d fit", count, TL_JOBS_MAX);
    for (int i = 0; i < count; i++) {
        if (!jobs[i].levels[0])
            return tl_fail(error, TL_USAGE, "job table: %s: has no level: name at least one", jobs[i].name);
        /* A resource that only its reader writes is that job's result of the last frame. */
        tl_bits known = jobs[i].writes;
        for (int k = 0; k < i; k++)
            known |= jobs[k].writes;
        for (int k = i + 1; k < count; k++)
            if (jobs[i].reads & jobs[k].writes & ~known)
                return tl_fail(error, TL_USAGE,
                               "job table: %s: reads what only %s writes, which comes later: put it before",
                               jobs[i].name, jobs[k].name);
    }
    return true;
}

/* "camera, surfaces" from bits; what does not fit is left out. */
static void name_bits(tl_bits bits, const char *const *names, char *out, size_t size)
{
    size_t length = 0;
    out[0] = '\0';
    for (int bit = 0; bit < (int)(8 * sizeof bits); bit++) {
        if (!(bits & (tl_bits)1 << bit))
            continue;
        const char *name = names && names[bit] ? names[bit] : "?";
        int added = snprintf(out + length, size - length, "%s%s", length ? ", " : "", name);
        if (added < 0 || (size_t)added >= size - length) {
            out[length] = '\0';
            return;
        }
        length += (size_t)added;
    }
}

static void give_reason(struct tl_plan_row *row, const char *before, tl_bits bits, const char *const *names,
                        const char *after)
{
    char list[90];
    name_bits(bits, names, list, sizeof list);
    snprintf(row->reason, sizeof row->reason, "%s%s%s", before, list, after);
}

static int level_count(const tl_job *job)
{
    int count = 0;
    while (count < TL_JOB_LEVELS_MAX && job->levels[count])
        count++;
    return count;
}

/* For each job, the inputs that have changed by its turn, if every job with a reason to run does run. */
static void spread_changes(const tl_job *jobs, int count, const struct tl_plan_input *input,
                           tl_bits changed_reads[])
{
    tl_bits changed = input->changed;
    for (int i = 0; i < count; i++) {
        bool allowed = (jobs[i].requires_scene & ~input->scene) == 0;
        changed_reads[i] = jobs[i].reads & changed;
        if (allowed && (changed_reads[i] || jobs[i].writes & ~input->valid))
            changed |= jobs[i].writes;
    }
}

static void plan_row(const tl_job *job, const struct tl_plan_input *input, tl_bits changed_reads,
                     tl_bits needed, struct tl_plan_row *row)
{
    tl_bits missing_facts = job->requires_scene & ~input->scene, missing = job->writes & ~input->valid;
    /* Without a budget there is no reason for less than the most exact level. */
    *row = (struct tl_plan_row){.name = job->name, .level = level_count(job) - 1};
    if (missing_facts) {
        row->action = TL_JOB_DROP;
        give_reason(row, "no ", missing_facts, input->scene_fact_names, " here");
    } else if (!(job->writes & needed)) {
        row->action = TL_JOB_DROP;
        give_reason(row, "nothing reads ", job->writes, input->resource_names, "");
    } else if (missing) {
        row->action = TL_JOB_RUN;
        give_reason(row, "not made yet: ", missing, input->resource_names, "");
    } else if (changed_reads) {
        row->action = TL_JOB_RUN;
        give_reason(row, "changed: ", changed_reads, input->resource_names, "");
    } else {
        row->action = TL_JOB_REUSE;
        give_reason(row, job->reads ? "as before: " : "made once", job->reads, input->resource_names, "");
    }
}

void tl_plan_make(const tl_job *jobs, int count, const struct tl_plan_input *input,
                  const double *predicted_ms, tl_plan *out)
{
    assert(count >= 0 && count <= TL_JOBS_MAX);
    tl_bits changed_reads[TL_JOBS_MAX], needed = input->wanted;
    spread_changes(jobs, count, input, changed_reads);
    *out = (tl_plan){.count = count};
    for (int i = count - 1; i >= 0; i--) { /* backwards: a job is needed if a later one reads its result */
        struct tl_plan_row *row = &out->rows[i];
        plan_row(&jobs[i], input, changed_reads[i], needed, row);
        if (row->action != TL_JOB_DROP)
            needed |= jobs[i].reads;
        if (row->action == TL_JOB_RUN)
            row->predicted_ms = predicted_ms ? predicted_ms[i] : (double)NAN;
    }
}

tl_bits tl_plan_valid_after(const tl_job *jobs, int count, const struct tl_plan_input *input,
                            const tl_plan *plan)
{
    tl_bits changed = input->changed, valid = input->valid, kept = 0;
    for (int i = 0; i < count; i++)
        if (plan->rows[i].action != TL_JOB_DROP)
            kept |= jobs[i].writes; /* several jobs may be ways to make one thing */
    for (int i = 0; i < count; i++) {
        enum tl_job_action action = plan->rows[i].action;
        if (action == TL_JOB_RUN)
            valid |= jobs[i].writes;
        else if (action == TL_JOB_DROP && jobs[i].reads & changed)
            valid &= ~(jobs[i].writes & ~kept);
        else
            continue;
        changed |= jobs[i].writes;
    }
    return valid;
}
