/* Names on a contact sheet: lists on the command line, labels, and parts of file names. Functions that return
 * char * return a new string; free() releases it. Threads: any. */
#ifndef TOILE_APP_SHEET_CONTACT_NAMES_H
#define TOILE_APP_SHEET_CONTACT_NAMES_H

#include "config/base/error.h"

#include <stddef.h>

/* A list of strings that owns them; starts as {0}. */
struct tl_names {
    char **items;
    size_t count;
};

/* Appends `item` and takes ownership of it. */
void tl_names_add(struct tl_names *names, char *item);
/* Frees the strings and leaves {0}. */
void tl_names_release(struct tl_names *names);

/* Reads the option `flag`, a list such as "a,b", into a new list. An option that was not given (NULL) gives a
 * list of `otherwise` alone. Errors: TL_USAGE for an empty name and for a name that stands there twice. */
bool tl_names_read(const char *flag, const char *text, const char *otherwise, struct tl_names *out,
                   tl_error *error);

/* Returns the label of a garment, a fabric or an environment: a file's name without its folders. */
char *tl_contact_label_of(const char *name);

/* Returns the first `length` bytes of a text with lower-case ASCII letters, and a dash for everything but
 * letters, digits and dots: a name that is safe in any file system. */
char *tl_contact_plain(const char *text, size_t length);

/* Returns the last part of a path as tl_contact_plain writes it, without a model's or map's extension:
 * "my-shirt". */
char *tl_contact_slug(const char *text);

/* Appends numbers to repeated slugs until all differ: two files of one name in different folders must not
 * share a cell. */
void tl_contact_make_unique(char **const *slugs, size_t count);

#endif
