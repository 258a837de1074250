/* A timeline of a flight in Chrome's trace format, which chrome://tracing and ui.perfetto.dev show: each
 * frame, the cloth's step and each job of the frame's table in one row, and below, for each thread of the
 * process, when it was busy.
 *
 * Busy is a thread that used at least half of a millisecond's processor time in that millisecond, by its own
 * clock. Threads of OpenMP and of software GL are among them; one that waits without sleeping counts as busy.
 * Events go to the file as they end, so that memory does not grow. Writes atomically, like tl_writer.
 * Failure: TL_OUTPUT. Threads: one at a time; a thread of its own reads the clocks. */
#ifndef TOILE_APP_LAB_FLIGHT_TIMELINE_H
#define TOILE_APP_LAB_FLIGHT_TIMELINE_H

#include "config/base/error.h"
#include "render/renderer.h"

typedef struct tl_timeline tl_timeline;

/* Begins the file and reads the clocks from now on. Fails when the file cannot be written. */
tl_timeline *tl_timeline_begin(const char *path, tl_error *error);
/* Adds what began at `began_s` of tl_clock_s and took `ms`. */
void tl_timeline_add(tl_timeline *trace, const char *name, double began_s, double ms);
/* Adds the jobs of a plan that ran. */
void tl_timeline_add_plan(tl_timeline *trace, const tl_plan *plan);
/* Completes the file and releases. */
bool tl_timeline_commit(tl_timeline **handle, tl_error *error);
void tl_timeline_abandon(tl_timeline **handle); /* leaves no file; null is fine */

#endif
