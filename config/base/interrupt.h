/* Ctrl-C: the first SIGINT, SIGTERM or SIGHUP (unless nohup ignores it) sets a flag that long loops poll. A
 * second one, TL_INTERRUPT_TWICE_MS later or more, removes the temporary files of open tl_writers and ends
 * the program with status 130. A signal that comes sooner is taken for the same request: timeout and some job
 * runners signal a process and then its process group, which reaches this process twice. A thread can be
 * given a flag of its own, which cancels that thread's work alone. Threads: any. */
#ifndef TOILE_CONFIG_BASE_INTERRUPT_H
#define TOILE_CONFIG_BASE_INTERRUPT_H

#include <stdatomic.h>
#include <stdbool.h>

#define TL_INTERRUPT_TWICE_MS 300

/* Installs the signal handlers; once, by main. */
void tl_interrupt_install(void);
/* Whether the calling thread should stop: a signal has come, or its own flag is set. */
bool tl_interrupted(void);

/* Makes tl_interrupted on this thread also return *flag; NULL removes the flag. `flag` is borrowed. */
void tl_interrupt_by(const atomic_bool *flag);

/* For tl_writer only: adds a temporary file to those that the second signal removes, and takes it out again.
 */
void tl_interrupt_guard(const char *temporary);
void tl_interrupt_unguard(const char *temporary);

/* Removes them, when the program ends in the middle of its work. Async-signal-safe. */
void tl_interrupt_remove_guarded(void);

#endif
