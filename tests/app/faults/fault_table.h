/* The faults of faults.txt: blocks of lines "key   value", apart by empty lines; # begins a comment.
 *
 *     fault   a name
 *     what    in words
 *     file    a source file of the program, or a shader
 *     from    a text that occurs once in it
 *     to      what takes its place where the fault is switched on: an expression (`value`) or statements
 * (`step`) kind    value, step, shader, or hook: no fault, always in the program rows    the invariants of
 * which one must break run     the arguments of `toile check`
 *
 * The table is this test's own file: what is wrong in it ends the program with a line that says what. */
#ifndef TOILE_TESTS_APP_FAULTS_FAULT_TABLE_H
#define TOILE_TESTS_APP_FAULTS_FAULT_TABLE_H

#include <stddef.h>

enum { FAULTS_MAX = 128 };

struct fault {
    char *name, *what, *file, *from, *to, *kind, *rows, *run;
};

struct fault_table {
    size_t count;
    struct fault items[FAULTS_MAX];
};

/* Never freed: both programs that read it end soon. */
struct fault_table fault_table_read(const char *path);
char *read_whole(const char *path); /* a new string */

#endif
