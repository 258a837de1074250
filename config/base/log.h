/* Log lines and progress, on stderr only: stdout is for results and --json.
 *
 * Threads: any. Lines are written whole. */
#ifndef TOILE_CONFIG_BASE_LOG_H
#define TOILE_CONFIG_BASE_LOG_H

#include <stdbool.h>

enum tl_log_level { TL_LOG_QUIET, TL_LOG_WARN, TL_LOG_INFO, TL_LOG_DEBUG };

/* Lines above `level` are dropped; the default is TL_LOG_INFO. */
void tl_log_set_level(enum tl_log_level level);

void tl_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));
void tl_info(const char *format, ...) __attribute__((format(printf, 1, 2)));
void tl_debug(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Progress of something that may take longer than two seconds. Nothing is shown before two seconds have
 * passed; on a terminal one line is redrawn, elsewhere a line is written every ten seconds. */
struct tl_progress {
    const char *what; /* "settling the cloth" */
    double started_s; /* monotonic clock */
    double shown_s;
    bool drawn;
};

struct tl_progress tl_progress_begin(const char *what);
void tl_progress_update(struct tl_progress *progress, double done, double total);
void tl_progress_end(struct tl_progress *progress);

/* Reports the progress of this thread's work to `observer` instead of stderr; NULL: to stderr again. `share`
 * is in [0, 1]. For windows, which show progress themselves. */
typedef void tl_progress_observer(void *user, const char *what, double share);
void tl_progress_observe(tl_progress_observer *observer, void *user);

/* Seconds on the monotonic clock. For show and for cost, never for results. */
double tl_clock_s(void);

#endif
