#include "app/measure/cost.h"

#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double clock_ms(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static struct tl_taken now(void)
{
    return (struct tl_taken){.cpu_ms = clock_ms(CLOCK_PROCESS_CPUTIME_ID),
                             .wall_ms = clock_ms(CLOCK_MONOTONIC)};
}

struct tl_stopwatch tl_stopwatch_start(void)
{
    return (struct tl_stopwatch){now()};
}

struct tl_taken tl_stopwatch_read(const struct tl_stopwatch *watch)
{
    struct tl_taken end = now();
    return (struct tl_taken){end.cpu_ms - watch->started.cpu_ms, end.wall_ms - watch->started.wall_ms};
}

static int compare_values(const void *a, const void *b)
{
    double first = *(const double *)a, second = *(const double *)b;
    return (first > second) - (first < second);
}

double tl_median(const double *values, size_t count)
{
    if (count == 0)
        return NAN;
    double *sorted = TL_NEW_ARRAY(double, count);
    memcpy(sorted, values, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, compare_values);
    double median = 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
    free(sorted);
    return median;
}
