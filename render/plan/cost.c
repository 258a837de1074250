#include "render/plan/cost.h"

#include <math.h>

#define MACHINE_DEVIATION 1.0  /* of the factor that all parts share, at first */
#define PART_DEVIATION    0.5  /* of each part's own factor, at first */
#define DRIFT             0.02 /* of the machine, from run to run */
#define PART_DRIFT        0.01 /* of a part: what is seen changes slowly */
#define NOISE             0.06 /* relative, of a measurement; added to NOISE_MS */
#define NOISE_MS          0.05
#define OUTLIER           3.0 /* standard deviations, beyond which a run is an outlier */
#define FIRST_RUNS        2   /* the first runs also allocate and compile: they weigh little */
#define BELIEVED_RUNS     5   /* ... and of the next ones none is taken for an outlier */
#define ONCE              0.8 /* ... but one that takes less of what was predicted: earlier ones did more */
#define FACTOR_MIN        0.02
#define UNIT_MIN_MS       0.05

#define LOAD_MIN     0.25
#define LOAD_MAX     16.0
#define LOAD_SUDDEN  0.15 /* a deviation that is followed at once */
#define LOAD_ATTACK  0.6
#define LOAD_FOLLOW  0.15
#define LOAD_FORGETS 0.01 /* towards 1: what lasts is learned by the jobs */

double tl_work_sum(const struct tl_work *work)
{
    double sum = 0;
    for (int i = 0; i < TL_WORK_PARTS; i++)
        sum += work->ms[i];
    return sum;
}

static struct tl_work known(const struct tl_cost_job *job, const struct tl_work *work)
{
    return tl_work_sum(work) > 0 ? *work : (struct tl_work){.ms = {job->unit_ms}};
}

static void begin(struct tl_cost_job *job, double ms)
{
    job->unit_ms = fmax(ms, UNIT_MIN_MS);
    for (int i = 0; i < TL_WORK_PARTS; i++) {
        job->factor[i] = 1;
        for (int k = 0; k < TL_WORK_PARTS; k++)
            job->covariance[i][k] =
                MACHINE_DEVIATION * MACHINE_DEVIATION + (i == k ? PART_DEVIATION * PART_DEVIATION : 0);
    }
}

double tl_cost_predict(const struct tl_cost_job *job, const struct tl_work *work, double load)
{
    if (job->runs == 0)
        return tl_work_sum(work) > 0 ? load * tl_work_sum(work) : (double)NAN;
    struct tl_work used = known(job, work);
    double ms = 0;
    for (int i = 0; i < TL_WORK_PARTS; i++)
        ms += job->factor[i] * used.ms[i];
    return load * ms;
}

double tl_cost_slowness(const struct tl_cost_job *jobs, const struct tl_work *work, int count)
{
    double table_ms = 0, ms = 0;
    for (int i = 0; i < count; i++) {
        if (jobs[i].runs == 0 || tl_work_sum(&work[i]) <= 0)
            continue;
        table_ms += tl_work_sum(&work[i]);
        ms += tl_cost_predict(&jobs[i], &work[i], 1);
    }
    return table_ms > 0 ? ms / table_ms : 1;
}

double tl_cost_expect(const struct tl_cost_job *job, const struct tl_work *work, double load, double slowness)
{
    double ms = tl_cost_predict(job, work, load), table_ms = slowness * load * tl_work_sum(work);
    if (job->runs >= TL_COST_KNOWN || table_ms <= 0)
        return ms;
    return job->runs > 0 ? fmin(ms, table_ms) : table_ms;
}

/* Process noise of the filter: all factors drift together by DRIFT, and each alone by PART_DRIFT until its
 * deviation reaches PART_DEVIATION. */
static void drift(struct tl_cost_job *job)
{
    for (int i = 0; i < TL_WORK_PARTS; i++) {
        double maximum = PART_DEVIATION * job->factor[i], part = PART_DRIFT * job->factor[i];
        if (job->covariance[i][i] < maximum * maximum)
            job->covariance[i][i] += part * part;
        for (int k = 0; k < TL_WORK_PARTS; k++)
            job->covariance[i][k] += DRIFT * DRIFT * job->factor[i] * job->factor[k];
    }
}

/* Work that is done once, such as compiling, makes runs slower and never faster. So an early run that is much
 * faster than predicted shows that those before it did such work, or that another program slowed them down:
 * they are forgotten. Averaged with the later ones, they would make all levels look expensive for ten runs
 * more. */
static bool shows_work_done_once(const struct tl_cost_job *job, const struct tl_work *work, double ms)
{
    return job->runs < BELIEVED_RUNS && ms < ONCE * tl_cost_predict(job, work, 1);
}

/* One step of the filter, with the part of the covariance along the work. */
void tl_cost_learn(struct tl_cost_job *job, const struct tl_work *work, double load, double ms)
{
    if (!isfinite(ms) || ms < 0)
        return;
    if (job->runs < FIRST_RUNS || shows_work_done_once(job, work, ms / load))
        begin(job, ms / load);
    job->runs++;
    struct tl_work used = known(job, work);
    drift(job);
    double along[TL_WORK_PARTS] = {0}, predicted = 0, variance = 0;
    for (int i = 0; i < TL_WORK_PARTS; i++) {
        predicted += job->factor[i] * used.ms[i];
        for (int k = 0; k < TL_WORK_PARTS; k++)
            along[i] += job->covariance[i][k] * used.ms[k];
        variance += along[i] * used.ms[i];
    }
    double noise = NOISE * predicted + NOISE_MS;
    variance += noise * noise;
    double limit = job->runs > BELIEVED_RUNS ? OUTLIER * sqrt(variance) : INFINITY;
    double surprise = fmin(fmax(ms / load - predicted, -limit), limit);
    for (int i = 0; i < TL_WORK_PARTS; i++) {
        job->factor[i] = fmax(job->factor[i] + along[i] / variance * surprise, FACTOR_MIN);
        for (int k = 0; k < TL_WORK_PARTS; k++)
            job->covariance[i][k] -= along[i] * along[k] / variance;
    }
}

double tl_machine_load_factor(const struct tl_machine_load *load)
{
    return load->factor > 0 ? load->factor : 1;
}

void tl_machine_load_follow(struct tl_machine_load *load, double predicted_ms, double took_ms)
{
    double factor = tl_machine_load_factor(load);
    if (!(predicted_ms > 0) || !isfinite(took_ms) || took_ms < 0)
        return;
    double seen = factor * took_ms / predicted_ms;
    bool is_sudden = seen > (1 + LOAD_SUDDEN) * factor, is_first = is_sudden && !load->was_sudden;
    load->was_sudden = is_sudden;
    if (is_first)
        return;
    factor += (is_sudden ? LOAD_ATTACK : LOAD_FOLLOW) * (seen - factor);
    factor += LOAD_FORGETS * (1 - factor);
    load->factor = fmin(fmax(factor, LOAD_MIN), LOAD_MAX);
}
