/* make_faults TABLE SOURCES OUT FILE: writes SOURCES/FILE with the faults of the table in it to OUT, each
 * behind TL_FAULT(name); FILE "shaders" writes those of shaders as a C table. A text that does not occur
 * exactly once is an error: the program has changed, and the table must follow. */
#include "tests/app/faults/fault_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char *find_once(const char *text, const struct fault *fault)
{
    char *found = strstr(text, fault->from);
    if (found && !strstr(found + 1, fault->from))
        return found;
    fprintf(stderr, "%s: \"%s\" occurs %s: change faults.txt (%s)\n", fault->file, fault->from,
            found ? "more than once" : "nowhere", fault->name);
    exit(1);
}

/* `from` is expanded as the innermost alternative of all faults that have it. */
static void write_faulty(FILE *out, const struct fault_table *table, const struct fault *first)
{
    int is_value = strcmp(first->kind, "value") == 0;
    if (strcmp(first->kind, "hook") == 0) {
        fputs(first->to, out);
        return;
    }
    if (!is_value)
        fputs("{ ", out);
    for (const struct fault *fault = first; fault < table->items + table->count; fault++) {
        if (strcmp(fault->file, first->file) != 0 || strcmp(fault->from, first->from) != 0)
            continue;
        if (is_value)
            fprintf(out, "(TL_FAULT(\"%s\") ? (%s) : ", fault->name, fault->to);
        else
            fprintf(out, "if (TL_FAULT(\"%s\")) { %s } else ", fault->name, fault->to);
    }
    fprintf(out, is_value ? "(%s)" : "{ %s } }", first->from);
    for (const struct fault *fault = first; is_value && fault < table->items + table->count; fault++)
        if (strcmp(fault->file, first->file) == 0 && strcmp(fault->from, first->from) == 0)
            fputc(')', out);
}

static void write_source(FILE *out, const struct fault_table *table, const char *file, const char *text)
{
    fprintf(out, "#include \"tests/app/faults/fault.h\"\n#line 1 \"%s\"\n", file);
    for (const char *at = text; *at;) {
        const struct fault *next = NULL;
        const char *place = NULL;
        for (size_t i = 0; i < table->count; i++) {
            const struct fault *fault = &table->items[i];
            if (strcmp(fault->file, file) != 0)
                continue;
            const char *found = find_once(text, fault);
            if (found >= at && (!next || found < place)) {
                next = fault;
                place = found;
            }
        }
        if (!next) {
            fputs(at, out);
            return;
        }
        fwrite(at, 1, (size_t)(place - at), out);
        write_faulty(out, table, next);
        at = place + strlen(next->from);
    }
}

static void write_string(FILE *out, const char *text)
{
    fputc('"', out);
    for (; *text; text++)
        fprintf(out, *text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
    fputc('"', out);
}

static void write_shaders(FILE *out, const struct fault_table *table, const char *sources)
{
    fprintf(out, "#include \"tests/app/faults/shader_faults.h\"\n\n"
                 "const struct shader_fault shader_faults[] = {\n");
    for (size_t i = 0; i < table->count; i++) {
        const struct fault *fault = &table->items[i];
        if (strcmp(fault->kind, "shader") != 0)
            continue;
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", sources, fault->file);
        find_once(read_whole(path), fault);
        const char *const parts[] = {fault->name, strrchr(fault->file, '/') + 1, fault->from, fault->to};
        fputs("    {", out);
        for (int p = 0; p < 4; p++) {
            write_string(out, parts[p]);
            fputs(p < 3 ? ", " : "},\n", out);
        }
    }
    fputs("    {0}};\n", out);
}

int main(int argc, char **argv)
{
    if (argc != 5) {
        fprintf(stderr, "usage: make_faults TABLE SOURCES OUT FILE\n");
        return 2;
    }
    const struct fault_table table = fault_table_read(argv[1]);
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", argv[2], argv[4]);
    FILE *out = fopen(argv[3], "wb");
    if (!out) {
        perror(argv[3]);
        return 1;
    }
    if (strcmp(argv[4], "shaders") == 0)
        write_shaders(out, &table, argv[2]);
    else
        write_source(out, &table, argv[4], read_whole(path));
    return fclose(out) == 0 ? 0 : 1;
}
