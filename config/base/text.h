/* Text files of numbers as lines of words: OBJ, MTL, and the text forms of PLY, STL and OFF. Threads: one a
 * text. */
#ifndef TOILE_CONFIG_BASE_TEXT_H
#define TOILE_CONFIG_BASE_TEXT_H

#include "config/base/error.h"

#include <locale.h>
#include <stdbool.h>
#include <stddef.h>

/* A text being read. Lines end in \n, \r\n or \r; a backslash before the end joins the next line. */
struct tl_text {
    const char *path; /* for messages; borrowed */
    char *data;
    char *next, *end; /* what follows the current line */
    char *word;       /* what follows the current word, within the line */
    size_t line;      /* number, from 1 */
    locale_t plain;   /* numbers are read in the C locale */
};

/* Reads a file; tl_text_close releases it, also after a failure. */
bool tl_text_open(const char *path, struct tl_text *out, tl_error *error);
void tl_text_close(struct tl_text *text);

/* Moves to the next line that has a word; false at the end. Lines that begin with # are comments. */
bool tl_text_next(struct tl_text *text);
/* The same, and returns that word; NULL at the end. */
char *tl_text_line(struct tl_text *text);
/* The line's next word, or NULL. */
char *tl_text_word(struct tl_text *text);
/* The rest of the line, without blanks at its ends; may be empty. */
char *tl_text_rest(struct tl_text *text);

/* Reads `count` finite numbers from the line's next words. False, with a message that names the line and
 * `what`, when one is missing or is no number. */
bool tl_text_numbers(struct tl_text *text, const char *what, int count, float *out, tl_error *error);

#endif
