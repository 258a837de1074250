/* Names on a contact sheet: as lists on the command line, as labels, and in the names of files. New strings.
 */
#ifndef TOILE_APP_SHEET_CONTACT_NAMES_H
#define TOILE_APP_SHEET_CONTACT_NAMES_H

#include "config/error.h"

#include <stddef.h>

struct tl_names {
    char **items;
    size_t count;
};

void tl_names_add(struct tl_names *names, char *item); /* takes it over */
void tl_names_release(struct tl_names *names);

/* "a,b": each once. An option that was not given is a list of `otherwise` alone. */
bool tl_names_read(const char *flag, const char *text, const char *otherwise, struct tl_names *out,
                   tl_error *error);

/* How a garment, a fabric or an environment is called on the sheet: a file without its folders. */
char *tl_contact_label_of(const char *name);

/* The first `length` bytes of a text as lower-case letters, digits, dots and dashes. */
char *tl_contact_plain(const char *text, size_t length);

/* The last part of a path so, without a model's or map's extension: "dress", "my-shirt". */
char *tl_contact_slug(const char *text);

/* Numbers those that are taken: two files of one name in different folders must not share a cell. */
void tl_contact_make_differ(char **const *slugs, size_t count);

#endif
