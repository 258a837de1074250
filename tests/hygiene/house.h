/* The house as the source tree shows it: files, rooms (folders that hold code), what includes what, and what
 * links to what. The rules are in test_house.c, the drawing in draw_house.c.
 *
 * A file's pair is its path without extension: a .c or .cpp file and the header of the same name. Ownership:
 * house_release frees everything. Errors: house_read and house_read_objects end the program with a message;
 * they read the project's own tree. Threads: one at a time. */
#ifndef TOILE_TESTS_HYGIENE_HOUSE_H
#define TOILE_TESTS_HYGIENE_HOUSE_H

#include <stdbool.h>
#include <stddef.h>

/* A directed graph with named nodes; at most one arrow from one node to another. */
struct graph {
    size_t count;
    char **names;   /* [count], each once */
    bool *arrows;   /* [count * count], row: from, column: to */
    char **because; /* [count * count] the first line or symbol that makes the arrow, or NULL */
};

void graph_create(struct graph *graph, char *const *names,
                  size_t count); /* copies the names, without arrows */
void graph_release(struct graph *graph);
size_t graph_find(const struct graph *graph, const char *name); /* graph->count when there is none */
void graph_add(struct graph *graph, size_t from, size_t to,
               const char *because);                                   /* ignores an arrow to itself */
bool graph_reaches(const struct graph *graph, size_t from, size_t to); /* by one arrow or more */
/* A circle: nodes that reach each other. Writes one with more than one node to circle[] and returns its size;
 * 0 when the graph has none. `skip` [count]: nodes that are left out; those of the circle are added to it. */
size_t graph_circle(const struct graph *graph, bool *skip, size_t *circle);
/* `height` [count]: the longest chain of arrows below each node. The graph has no circle. */
void graph_heights(const struct graph *graph, int *height);

struct house_include {
    char *header; /* as it is written between the quotes or brackets */
    bool quoted;
    size_t line;
};

struct house_file {
    char *path, *room, *pair; /* from the root: cloth/mesh/rigid.c, cloth/mesh, cloth/mesh/rigid */
    size_t line_count;
    struct house_include *includes;
    size_t include_count;
    char *unreadable; /* an #include line that names no file, or NULL */
};

struct house {
    struct house_file *files; /* .c, .h, .cpp of the floors, then of tests/; sorted by path in each */
    size_t file_count;
    size_t own_count;     /* of them in the floors */
    struct graph pairs;   /* of the floors' files, by linked symbols: house_read_objects */
    struct graph headers; /* of the floors' headers, by includes */
    struct graph rooms;   /* of the floors, by both */
};

extern const char *const house_floors[]; /* lowest first; NULL-terminated */

void house_read(struct house *house, const char *root);
/* Adds the arrows that linked symbols make: a pair uses what another one defines. `list`: a file that names
 * an object file a line, ROOT/<folder>/CMakeFiles/<target>.dir/<rest>/<file>.o. Needs nm (binutils). */
void house_read_objects(struct house *house, const char *list, const char *root);
void house_release(struct house *house);

bool house_starts_with_folder(const char *path, const char *folder);
bool house_ends_with(const char *text, const char *end);

#endif
