/* Inside the option tables: one value as text and back, and how a row or a table is found and missed. Shared
 * by options*.c; others use config/options.h. */
#ifndef TOILE_CONFIG_OPTIONS_VALUE_H
#define TOILE_CONFIG_OPTIONS_VALUE_H

#include "config/options.h"

/* Describes the values that a row accepts, as in "a whole number from 6 to 384 texels". New string. */
char *tl_option_expectation(const struct tl_option *row);

/* Converts text to the row's type and stores it in the field. On failure the field is untouched and the
 * result is the reason, a new string; NULL means success. */
char *tl_option_read(const struct tl_option *row, const char *text, const char *base_file, void *field);

/* A number of plain digits in the C locale, whatever its range; neither NaN nor infinity. False for another
 * text. */
bool tl_option_parse_number(const char *text, double *value);

/* True when the row's numbers are of single precision. */
bool tl_option_is_single(const struct tl_option *row);

/* Reason for a refusal: the text, what is wrong with it, what was expected, and the nearest word unless that
 * is NULL. New string. */
char *tl_option_refuse(const struct tl_option *row, const char *text, const char *fault, const char *near);

/* Converts a field to text that tl_option_read accepts. New string. */
char *tl_option_write(const struct tl_option *row, const void *field);

/* Bytes of a field of the row's type. */
size_t tl_option_size(const struct tl_option *row);

/* Start of `text`, short enough for a message, on a character's border. */
struct tl_excerpt {
    char text[72];
};
struct tl_excerpt tl_excerpt_of(const char *text);

/* The binding of the table whose name is the first `length` bytes of `name`; NULL when there is none. */
const struct tl_binding *tl_options_find_table(const struct tl_binding *bindings, size_t count,
                                               const char *name, size_t length);
/* NULL when there is none. */
const struct tl_option *tl_options_find_row(const struct tl_option_table *table, const char *name);
/* The message for a table that there is none of. Returns false. */
bool tl_options_fail_table(const struct tl_binding *bindings, size_t count, const char *name,
                           const char *where, tl_error *error);

#endif
