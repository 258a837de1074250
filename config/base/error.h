/* One way to fail: a function returns false (or NULL) and fills a tl_error.
 *
 * A message is one line, "what: where: remedy", meant for a person: it names the file, line or option, states
 * what was expected, and what to do. The code decides the exit status. Threads: a tl_error belongs to its
 * caller. */
#ifndef TOILE_CONFIG_BASE_ERROR_H
#define TOILE_CONFIG_BASE_ERROR_H

#include <stdbool.h>

enum tl_code {
    TL_OK,
    TL_USAGE,       /* bad command line, option or scene key          -> exit 2 */
    TL_INPUT,       /* a file that cannot be read or makes no sense    -> exit 2 */
    TL_OUTPUT,      /* a file that cannot be written                   -> exit 2 */
    TL_DEVICE,      /* no usable GL, no display                        -> exit 2 */
    TL_UNSTABLE,    /* a computation left its stated envelope          -> exit 1 */
    TL_INTERRUPTED, /* Ctrl-C                                          -> exit 130 */
};

typedef struct tl_error {
    enum tl_code code;
    char message[1024];
} tl_error;

/* Fills `error` (unless NULL) and returns false, so that `return tl_fail(...)` reads well.
 * Control characters that came from a file are replaced by '?'; a longer message is cut. */
bool tl_fail(tl_error *error, enum tl_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Replaces by '?' what a terminal would take for a command: control characters (line ends and tabs
 * included), also those of the second set (U+0080 to U+009F) in UTF-8, and bytes that begin none of UTF-8's
 * sequences. Text of any script stays. */
void tl_clean_line(char *text);

/* Exit status of the program for a code. */
int tl_exit_status(enum tl_code code);

/* Prints "toile: " and one line of at most 150 bytes, removes temporary files (config/base/interrupt.h) and
 * ends the program with status 2: for what the system refuses and no caller can continue without. Allocates
 * nothing. Threads: any. */
void tl_end_program(const char *format, ...) __attribute__((noreturn, format(printf, 1, 2)));

#endif
