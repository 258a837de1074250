/* Which contents the files of a folder may have after a run: those that they had before it, and those that a
 * run without refusals gives them, at its end or on the way. Threads: one caller. */
#ifndef TOILE_TESTS_APP_INJECT_FOLDER_H
#define TOILE_TESTS_APP_INJECT_FOLDER_H

#include <stddef.h>
#include <stdint.h>

enum known_when { KNOWN_BEFORE, KNOWN_BETWEEN, KNOWN_AFTER };

struct known_file {
    char *path; /* relative to the folder */
    uint64_t hash;
    enum known_when when; /* in which part of a run without refusals */
};

struct known_files {
    struct known_file *files;
    size_t count;
};

/* Adds the files below `folder`; of one that does not exist nothing. */
void known_add_all(struct known_files *known, const char *folder, enum known_when when);
/* Adds one file's present contents as those of `path`, in between. */
void known_add(struct known_files *known, const char *folder, const char *file, const char *path);
void known_release(struct known_files *known);

/* Describes in `problem` the first file of `folder` that a run must not leave: a temporary one, one whose
 * contents are not known and that is not whole by its form, one that is missing although it is there before
 * and after, and, of a complete run, one other than a complete run leaves it. The folder cache/ need not be
 * complete. Returns whether there is one.
 */
int known_find_problem(const struct known_files *known, const char *folder, int is_complete, char *problem,
                       size_t size);

#endif
