#include "config/base/log.h"

#include "config/base/error.h"
#include "config/base/interrupt.h"

#include <stdarg.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

static enum tl_log_level current_level = TL_LOG_INFO;
static _Thread_local tl_progress_observer *current_observer;
static _Thread_local void *observer_user;

void tl_log_set_level(enum tl_log_level level)
{
    current_level = level;
}

static void write_line(enum tl_log_level level, const char *prefix, const char *format, va_list arguments)
{
    if (level > current_level)
        return;
    char text[2048];
    vsnprintf(text, sizeof text, format, arguments);
    tl_clean_line(text);
    fprintf(stderr, "toile: %s%s\n", prefix, text); /* one call: stderr locks per call, so lines stay whole */
}

void tl_warn(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_line(TL_LOG_WARN, "warning: ", format, arguments);
    va_end(arguments);
}

void tl_info(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_line(TL_LOG_INFO, "", format, arguments);
    va_end(arguments);
}

void tl_debug(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    write_line(TL_LOG_DEBUG, "debug: ", format, arguments);
    va_end(arguments);
}

double tl_clock_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void tl_progress_observe(tl_progress_observer *observer, void *user)
{
    current_observer = observer;
    observer_user = user;
}

struct tl_progress tl_progress_begin(const char *what)
{
    double now = tl_clock_s();
    if (current_observer)
        current_observer(observer_user, what, 0);
    return (struct tl_progress){.what = what, .started_s = now, .shown_s = now};
}

void tl_progress_update(struct tl_progress *progress, double done, double total)
{
    const double silent_s = 2.0, redraw_s = 0.1, line_s = 10.0;
    double now = tl_clock_s(), share = total > 0 ? done / total : 0;
    if (current_observer) {
        current_observer(observer_user, progress->what, share);
        return;
    }
    if (current_level < TL_LOG_INFO || now - progress->started_s < silent_s)
        return;
    bool terminal = isatty(STDERR_FILENO);
    if (progress->drawn && now - progress->shown_s < (terminal ? redraw_s : line_s))
        return;
    double left_s = share > 0 ? (now - progress->started_s) * (1 - share) / share : 0;
    if (terminal)
        fprintf(stderr, "\rtoile: %s: %3.0f %%, about %.0f s left\033[K", progress->what, 100 * share,
                left_s);
    else
        fprintf(stderr, "toile: %s: %3.0f %%, about %.0f s left\n", progress->what, 100 * share, left_s);
    progress->shown_s = now;
    progress->drawn = true;
}

void tl_progress_end(struct tl_progress *progress)
{
    if (progress->drawn && isatty(STDERR_FILENO))
        fprintf(stderr, "\r\033[K");
    if (progress->drawn)
        tl_info("%s: done in %.1f s", progress->what, tl_clock_s() - progress->started_s);
}
