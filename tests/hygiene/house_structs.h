/* The structs that the house's files define. */
#ifndef TOILE_TESTS_HYGIENE_HOUSE_STRUCTS_H
#define TOILE_TESTS_HYGIENE_HOUSE_STRUCTS_H

#include "tests/hygiene/house.h"

/* Finds the first definition `struct NAME {` in C or C++ text. Copies its name (`size` bytes, truncated) and
 * returns the text behind it; NULL if there is none. Struct types without a name, declarations, variables and
 * compound literals are no definitions. */
const char *house_next_struct(const char *text, char *name, size_t size);

struct house_struct {
    char *name;
    const char *path; /* borrowed from the house */
};

/* All definitions in the floors' files, sorted by name, then by path. New array: house_structs_release. Ends
 * the program if a file cannot be read. */
struct house_struct *house_structs_read(const struct house *house, const char *root, size_t *count);
void house_structs_release(struct house_struct **structs, size_t count);

#endif
