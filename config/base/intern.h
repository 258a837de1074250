/* Interned texts: one copy of each text, which lives as long as the program. A struct that points to such
 * texts is copied by assignment, and none of its copies owns anything.
 *
 * Errors: none. Lifetime: what is returned is never released, so texts without bound (a file's contents)
 * do not belong here. Threads: any. */
#ifndef TOILE_CONFIG_BASE_INTERN_H
#define TOILE_CONFIG_BASE_INTERN_H

/* The copy of `text`: the same pointer for equal texts. */
const char *tl_intern(const char *text);

#endif
