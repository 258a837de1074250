/* The text of the project: every file that a person writes, as one line of words without the marks of
 * comments.
 *
 * Ownership: sources_release frees everything. Errors: sources_read ends the program with a message; it reads
 * the project's own tree. Threads: one at a time. */
#ifndef TOILE_TESTS_HYGIENE_SOURCES_H
#define TOILE_TESTS_HYGIENE_SOURCES_H

#include <stddef.h>

struct source {
    char *path;    /* from the root: cloth/mesh/rigid.c */
    char *text;    /* as the file has it */
    char *joined;  /* the same; what a line break parts within a comment or a string is joined by a blank */
    size_t *lines; /* [strlen(joined)] from 1: the line of each character of `joined` */
};

struct sources {
    struct source *files; /* sorted by path */
    size_t count;
};

void sources_read(struct sources *sources, const char *root);
void sources_release(struct sources *sources);

/* The joined form of `text`, of a file whose name ends as `path` does. The caller frees both. */
char *sources_join(const char *path, const char *text, size_t **lines);

#endif
