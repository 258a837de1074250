/* Figures of a recorded flight: percentiles, shares, medians, and the comparison of two flights. Pure.
 *
 * Only frames after the warm-up count. Milliseconds. */
#ifndef TOILE_APP_LAB_FLIGHT_FLY_FIGURES_H
#define TOILE_APP_LAB_FLIGHT_FLY_FIGURES_H

#include "app/lab/flight/fly.h"

#define TL_FLIGHT_TOLERANCE 1.1 /* a frame keeps its time within this multiple of the budget */

struct tl_flight_figures {
    int judged; /* frames after the warm-up */
    double mean_ms, p50_ms, p95_ms, p99_ms, worst_ms;
    double cloth_ms;         /* median */
    double cpu_p50_ms;       /* median of the frames' CPU time; NaN: not recorded */
    double load;             /* of the machine: mean of the frames; NaN: not recorded */
    double within;           /* share of frames that keep their time; NaN without a budget */
    int over_budget;         /* frames above the budget itself */
    double prediction_error; /* median of |predicted - measured| / measured; NaN: nothing was predicted */
    double estimated_error;  /* mean of the frames' estimates; NaN: none */
    size_t memory_bytes;     /* largest */
    int oracle_frames;       /* frames compared with the reference, warm-up included */
    /* Over these frames; NaN: none. */
    int garment_frames;        /* those of them that show the garment */
    double garment_flip;       /* mean FLIP over the garment's pixels: mean of the frames, ... */
    double garment_flip_max;   /* ... and the largest */
    double garment_flip_worst; /* mean of the largest 5 % of the garment's pixels: mean of the frames */
    double flip_mean, rel_rmse, flip_max; /* over all covered pixels: means, and the largest mean FLIP */
};
struct tl_flight_figures tl_flight_measure(const struct tl_flight *flight);

/* The smallest value that at least `share` of the values do not exceed (nearest rank); NaN of none. */
double tl_percentile(const double *values, size_t count, double share);

/* Time of one job in the frames in which it ran. */
struct tl_flight_job {
    double median_ms, total_ms; /* NaN and 0 when it never ran */
    int ran;
};
struct tl_flight_job tl_flight_measure_job(const struct tl_flight *flight, int job);

/* The time of one part over its time in an earlier flight along the same path: the ratio of medians
 * over frames that both have, and the interval that holds it with 95 % by a bootstrap over the same pairs, in
 * blocks of a second, because successive frames are alike. It includes the noise within each run, but not a
 * machine that was busier during one of them: that shows in the frame's CPU time, which does not grow with
 * its wall time then. Where the verdicts of the two differ, or CPU time was not recorded, no row has one. */
struct tl_flight_ratio {
    char name[TL_JOB_NAME_BYTES]; /* "frame", "frame (CPU)", "cloth" or a job's */
    double this_ms, that_ms;
    double ratio, low, high;
    enum { TL_FLIGHT_ALIKE, TL_FLIGHT_FASTER, TL_FLIGHT_SLOWER, TL_FLIGHT_UNCLEAR } verdict;
};
#define TL_FLIGHT_RATIOS_MAX (TL_JOBS_MAX + 3)

/* Compares the whole frame, its CPU time, the cloth, and every job that ran in both flights, in this order;
 * returns the number of ratios. A job counts as slower or faster when 1 lies outside of its interval and the
 * difference of medians is at least TL_FLIGHT_NOTICED of the frame's. */
int tl_flight_compare(const struct tl_flight *here, const struct tl_flight *there,
                      struct tl_flight_ratio out[TL_FLIGHT_RATIOS_MAX]);
#define TL_FLIGHT_NOTICED 0.01

/* The ratio of medians of `count` pairs, and its interval; blocks of `block` consecutive pairs are resampled
 * together. */
struct tl_flight_ratio tl_ratio_of_medians(const double *here, const double *there, size_t count,
                                           size_t block);

#endif
