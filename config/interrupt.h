/* Ctrl-C: the first SIGINT or SIGTERM sets a flag that long loops ask for; one that comes
 * TL_INTERRUPT_TWICE_MS later or more removes the temporary files of open tl_writers and ends the program
 * with status 130. (What comes sooner is the same request: timeout and some job runners signal a process and
 * then its group, this process again.) A thread can be given a flag of its own, so that one piece of work
 * stops where the whole program would. */
#ifndef TOILE_CONFIG_INTERRUPT_H
#define TOILE_CONFIG_INTERRUPT_H

#include <stdatomic.h>
#include <stdbool.h>

#define TL_INTERRUPT_TWICE_MS 300

void tl_interrupt_install(void);
bool tl_interrupted(void);

/* From now on tl_interrupted is true on this thread once *flag is; NULL ends that. Borrowed. */
void tl_interrupt_by(const atomic_bool *flag);

/* For tl_writer only: remembers a temporary file that a killed program must remove; forgets it again. */
void tl_interrupt_guard(const char *temporary);
void tl_interrupt_unguard(const char *temporary);

#endif
