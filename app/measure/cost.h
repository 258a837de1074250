/* Time of a piece of work: CPU time of all threads of the process (those of software GL included) and wall
 * time; and medians. Times are reported and steer costs; results never depend on them. */
#ifndef TOILE_APP_MEASURE_COST_H
#define TOILE_APP_MEASURE_COST_H

#include <stddef.h>

struct tl_taken {
    double cpu_ms, wall_ms;
};

struct tl_stopwatch {
    struct tl_taken started;
};

struct tl_stopwatch tl_stopwatch_start(void);
struct tl_taken tl_stopwatch_read(const struct tl_stopwatch *watch); /* since the start */

/* The median of `count` values in any order: for an even count the mean of the middle two, for 0 NaN. */
double tl_median(const double *values, size_t count);

#endif
