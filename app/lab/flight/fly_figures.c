#include "app/lab/flight/fly_figures.h"

#include "app/measure/cost.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int compare_values(const void *a, const void *b)
{
    double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

double tl_percentile(const double *values, size_t count, double share)
{
    if (count == 0)
        return NAN;
    double *sorted = TL_NEW_ARRAY(double, count);
    memcpy(sorted, values, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, compare_values);
    double rank = ceil(share * (double)count);
    double value = sorted[rank < 1 ? 0 : (size_t)rank - 1];
    free(sorted);
    return value;
}

/* Numbers of the frames that count and have one: those that are NaN are left out. */
struct numbers {
    double *values;
    size_t count;
};

static void add_number(struct numbers *numbers, double value)
{
    if (isfinite(value))
        numbers->values[numbers->count++] = value;
}

static double mean_of(const struct numbers *numbers)
{
    double sum = 0;
    for (size_t i = 0; i < numbers->count; i++)
        sum += numbers->values[i];
    return numbers->count ? sum / (double)numbers->count : (double)NAN;
}

static void measure_times(const struct tl_flight *flight, struct numbers *numbers,
                          struct tl_flight_figures *out)
{
    int kept = 0;
    for (int i = flight->warm_up; i < flight->count; i++) {
        double total_ms = flight->frames[i].total_ms;
        add_number(numbers, total_ms);
        kept += total_ms <= TL_FLIGHT_TOLERANCE * flight->budget_ms;
        out->over_budget += flight->budget_ms > 0 && total_ms > flight->budget_ms;
        if (flight->frames[i].memory_bytes > out->memory_bytes)
            out->memory_bytes = flight->frames[i].memory_bytes;
    }
    out->judged = (int)numbers->count;
    out->mean_ms = mean_of(numbers);
    out->p50_ms = tl_percentile(numbers->values, numbers->count, 0.5);
    out->p95_ms = tl_percentile(numbers->values, numbers->count, 0.95);
    out->p99_ms = tl_percentile(numbers->values, numbers->count, 0.99);
    out->worst_ms = tl_percentile(numbers->values, numbers->count, 1);
    out->within = flight->budget_ms > 0 && out->judged ? (double)kept / out->judged : (double)NAN;
}

static void measure_oracle(const struct tl_flight *flight, struct tl_flight_figures *out)
{
    double flip = 0, rmse = 0, highest = 0, garment = 0, garment_worst = 0, garment_highest = 0;
    for (int i = 0; i < flight->count; i++) {
        const struct tl_flight_frame *frame = &flight->frames[i];
        if (!isfinite(frame->flip_mean) || !isfinite(frame->rel_rmse))
            continue;
        out->oracle_frames++;
        flip += frame->flip_mean;
        rmse += frame->rel_rmse;
        highest = fmax(highest, frame->flip_mean);
        if (!isfinite(frame->garment_flip) || !isfinite(frame->garment_flip_worst))
            continue;
        out->garment_frames++;
        garment += frame->garment_flip;
        garment_worst += frame->garment_flip_worst;
        garment_highest = fmax(garment_highest, frame->garment_flip);
    }
    double shown = out->garment_frames ? out->garment_frames : (double)NAN;
    out->garment_flip = garment / shown;
    out->garment_flip_worst = garment_worst / shown;
    out->garment_flip_max = out->garment_frames ? garment_highest : (double)NAN;
    double count = out->oracle_frames ? out->oracle_frames : (double)NAN;
    out->flip_mean = flip / count;
    out->rel_rmse = rmse / count;
    out->flip_max = out->oracle_frames ? highest : (double)NAN;
}

struct tl_flight_figures tl_flight_measure(const struct tl_flight *flight)
{
    struct tl_flight_figures figures = {0};
    struct numbers numbers = {.values = TL_NEW_ARRAY(double, (size_t)flight->count)};
    measure_times(flight, &numbers, &figures);
    numbers.count = 0;
    for (int i = flight->warm_up; i < flight->count; i++)
        add_number(&numbers, flight->frames[i].cloth_ms);
    figures.cloth_ms = tl_median(numbers.values, numbers.count);
    numbers.count = 0;
    for (int i = flight->warm_up; i < flight->count; i++)
        add_number(&numbers, flight->frames[i].cpu_ms);
    figures.cpu_p50_ms = tl_median(numbers.values, numbers.count);
    numbers.count = 0;
    for (int i = flight->warm_up; i < flight->count; i++)
        add_number(&numbers, flight->frames[i].load);
    figures.load = mean_of(&numbers);
    numbers.count = 0;
    for (int i = flight->warm_up; i < flight->count; i++) {
        const struct tl_flight_frame *frame = &flight->frames[i];
        add_number(&numbers, fabs(frame->predicted_ms - frame->total_ms) / frame->total_ms);
    }
    figures.prediction_error = tl_median(numbers.values, numbers.count);
    numbers.count = 0;
    for (int i = flight->warm_up; i < flight->count; i++)
        add_number(&numbers, flight->frames[i].error);
    figures.estimated_error = mean_of(&numbers);
    free(numbers.values);
    measure_oracle(flight, &figures);
    return figures;
}

struct tl_flight_job tl_flight_measure_job(const struct tl_flight *flight, int job)
{
    struct tl_flight_job result = {0};
    struct numbers numbers = {.values = TL_NEW_ARRAY(double, (size_t)flight->count)};
    for (int i = flight->warm_up; i < flight->count; i++)
        if (flight->frames[i].job_ms[job] > 0) {
            add_number(&numbers, flight->frames[i].job_ms[job]);
            result.total_ms += flight->frames[i].job_ms[job];
        }
    result.ran = (int)numbers.count;
    result.median_ms = tl_median(numbers.values, numbers.count);
    free(numbers.values);
    return result;
}

/* Numerical Recipes' quick generator: enough to draw blocks, and the same on every machine. */
static size_t draw(uint32_t *state, size_t count)
{
    *state = *state * 1664525u + 1013904223u;
    return (size_t)(((uint64_t)*state * count) >> 32);
}

struct tl_flight_ratio tl_ratio_of_medians(const double *here, const double *there, size_t count,
                                           size_t block)
{
    enum { DRAWS = 400 };
    struct tl_flight_ratio result = {.this_ms = tl_median(here, count), .that_ms = tl_median(there, count)};
    result.ratio = result.this_ms / result.that_ms;
    double ratios[DRAWS];
    double *first = TL_NEW_ARRAY(double, count), *second = TL_NEW_ARRAY(double, count);
    uint32_t state = 1;
    for (int i = 0; i < DRAWS; i++) {
        for (size_t filled = 0, from = 0; filled < count; filled++) {
            from = filled % block == 0 ? draw(&state, count) : (from + 1) % count;
            first[filled] = here[from];
            second[filled] = there[from];
        }
        ratios[i] = tl_median(first, count) / tl_median(second, count);
    }
    result.low = tl_percentile(ratios, DRAWS, 0.025);
    result.high = tl_percentile(ratios, DRAWS, 0.975);
    free(first);
    free(second);
    return result;
}

/* Pairs of numbers from the frames that both flights have. */
struct pairs {
    double *here, *there;
    size_t count;
};

enum { WHOLE_FRAME = -3, FRAME_CPU = -2, CLOTH = -1 }; /* what is no job */
static const char *const no_jobs[] = {"frame", "frame (CPU)", "cloth"};

static double value_of(const struct tl_flight_frame *frame, int job)
{
    if (job >= 0)
        return frame->job_ms[job];
    return job == WHOLE_FRAME ? frame->total_ms : job == FRAME_CPU ? frame->cpu_ms : frame->cloth_ms;
}

static void find_pairs(const struct tl_flight *here, int job, const struct tl_flight *there, int other_job,
                       struct pairs *out)
{
    int first = here->warm_up > there->warm_up ? here->warm_up : there->warm_up;
    out->count = 0;
    for (int i = first; i < here->count && i < there->count; i++) {
        double a = value_of(&here->frames[i], job), b = value_of(&there->frames[i], other_job);
        if (!(a > 0 && b > 0)) /* it did not run in both */
            continue;
        out->here[out->count] = a;
        out->there[out->count++] = b;
    }
}

static int find_job(const struct tl_flight *flight, const char *name)
{
    for (int i = 0; i < flight->job_count; i++)
        if (strcmp(flight->job_names[i], name) == 0)
            return i;
    return flight->job_count;
}

static void judge(struct tl_flight_ratio *ratio, double frame_ms)
{
    bool noticed = fabs(ratio->this_ms - ratio->that_ms) >= TL_FLIGHT_NOTICED * frame_ms;
    if (noticed && ratio->low > 1)
        ratio->verdict = TL_FLIGHT_SLOWER;
    else if (noticed && ratio->high < 1)
        ratio->verdict = TL_FLIGHT_FASTER;
}

/* Wall and CPU time of the frame, the first two rows, have to agree: see the header. */
static void withhold(struct tl_flight_ratio *ratios, int count)
{
    if (count > 1 && strcmp(ratios[1].name, no_jobs[FRAME_CPU - WHOLE_FRAME]) == 0 &&
        ratios[0].verdict == ratios[1].verdict)
        return;
    for (int i = 0; i < count; i++)
        ratios[i].verdict = TL_FLIGHT_UNCLEAR;
}

int tl_flight_compare(const struct tl_flight *here, const struct tl_flight *there,
                      struct tl_flight_ratio out[TL_FLIGHT_RATIOS_MAX])
{
    const size_t fewest = 5;  /* of fewer pairs a median means nothing */
    const double blocks = 10; /* at least, of a short flight */
    struct pairs pairs = {.here = TL_NEW_ARRAY(double, (size_t)here->count),
                          .there = TL_NEW_ARRAY(double, (size_t)here->count)};
    int count = 0;
    for (int job = WHOLE_FRAME; job < here->job_count; job++) {
        const char *name = job < 0 ? no_jobs[job - WHOLE_FRAME] : here->job_names[job];
        int other = job < 0 ? job : find_job(there, name);
        if (other == there->job_count)
            continue;
        find_pairs(here, job, there, other, &pairs);
        if (pairs.count < fewest)
            continue;
        double block = fmax(fmin(rint(here->frame_rate), floor((double)pairs.count / blocks)), 1);
        out[count] = tl_ratio_of_medians(pairs.here, pairs.there, pairs.count, (size_t)block);
        snprintf(out[count].name, sizeof out[count].name, "%s", name);
        judge(&out[count], out[job == FRAME_CPU ? count : 0].that_ms);
        count++;
    }
    withhold(out, count);
    free(pairs.here);
    free(pairs.there);
    return count;
}
