/* Other programs, run with streams of this one's.
 *
 * Errors: stated by each function. Lifetime: every process that started is waited for once. Threads: any. */
#ifndef TOILE_CONFIG_PROCESS_H
#define TOILE_CONFIG_PROCESS_H

#include <sys/types.h>

/* Starts the program arguments[0], looked for in PATH, with these file descriptors as stdin, stdout and
 * stderr. Waits for nothing. It is in a group of its own, so that Ctrl-C on the terminal reaches this program
 * only. Returns 0, or an error number. */
int tl_process_start(char *const arguments[], int input, int output, int log, pid_t *out);

/* Waits for its end. Returns its exit status; -1 when a signal ended it. */
int tl_process_wait(pid_t process);

#endif
