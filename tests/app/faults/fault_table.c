#include "tests/app/faults/fault_table.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void give_up(const char *path, int line, const char *why)
{
    fprintf(stderr, "%s:%d: %s\n", path, line, why);
    exit(1);
}

char *read_whole(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0)
        give_up(path, 0, "cannot be read");
    size_t size = (size_t)ftell(file);
    char *text = malloc(size + 1);
    rewind(file);
    if (!text || fread(text, 1, size, file) != size)
        give_up(path, 0, "cannot be read");
    text[size] = 0;
    fclose(file);
    return text;
}

static char **member_of(struct fault *fault, const char *key)
{
    const struct {
        const char *key;
        char **member;
    } members[] = {{"fault", &fault->name}, {"what", &fault->what}, {"file", &fault->file},
                   {"from", &fault->from},  {"to", &fault->to},     {"kind", &fault->kind},
                   {"rows", &fault->rows},  {"run", &fault->run}};
    for (size_t i = 0; i < sizeof members / sizeof members[0]; i++)
        if (strcmp(members[i].key, key) == 0)
            return members[i].member;
    return NULL;
}

static int is_whole(const struct fault *fault)
{
    return fault->name && fault->what && fault->file && fault->from && fault->to && fault->kind &&
           fault->rows && fault->run;
}

struct fault_table fault_table_read(const char *path)
{
    struct fault_table table = {0};
    int number = 0, inside = 0;
    for (char *line = strtok(read_whole(path), "\n"), *next; line; line = next) {
        next = strtok(NULL, "\n");
        number++;
        if (line[0] == '#')
            continue;
        size_t length = strcspn(line, " ");
        char *value = line + length + strspn(line + length, " ");
        line[length] = 0;
        if (strcmp(line, "fault") == 0) {
            if (inside && !is_whole(&table.items[table.count - 1]))
                give_up(path, number, "the fault before this one is not whole");
            if (table.count == FAULTS_MAX)
                give_up(path, number, "too many faults");
            table.count++;
            inside = 1;
        }
        char **member = inside ? member_of(&table.items[table.count - 1], line) : NULL;
        if (!member || !*value)
            give_up(path, number, "no such key, or nothing after it");
        *member = value;
    }
    if (table.count == 0 || !is_whole(&table.items[table.count - 1]))
        give_up(path, number, "the last fault is not whole");
    return table;
}
