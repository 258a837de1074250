#include "tests/hygiene/house_structs.h"

#include "config/base/file.h"
#include "config/base/memory.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool is_name(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

const char *house_next_struct(const char *text, char *name, size_t size)
{
    static const char keyword[] = "struct";
    for (const char *at = text; (at = strstr(at, keyword)) != NULL; at += strlen(keyword)) {
        if (at > text && is_name(at[-1]))
            continue; /* the end of another word */
        const char *begin = at + strlen(keyword), *end;
        if (!isspace((unsigned char)*begin))
            continue;
        begin += strspn(begin, " \t\n");
        for (end = begin; is_name(*end); end++)
            ;
        if (end == begin || end[strspn(end, " \t\n")] != '{')
            continue;
        snprintf(name, size, "%.*s", (int)(end - begin), begin);
        return end;
    }
    return NULL;
}

static int by_name(const void *a, const void *b)
{
    const struct house_struct *left = a, *right = b;
    int order = strcmp(left->name, right->name);
    return order ? order : strcmp(left->path, right->path);
}

struct house_struct *house_structs_read(const struct house *house, const char *root, size_t *count)
{
    struct house_struct *structs = NULL;
    *count = 0;
    for (size_t i = 0; i < house->own_count; i++) {
        char *path = tl_format("%s/%s", root, house->files[i].path), *text = NULL, name[256];
        size_t size = 0;
        tl_error error = {0};
        if (!tl_file_read(path, &text, &size, &error)) {
            fprintf(stderr, "%s\n", error.message);
            exit(1);
        }
        for (const char *at = text; (at = house_next_struct(at, name, sizeof name)) != NULL;) {
            structs = tl_resize(structs, *count + 1, sizeof *structs);
            structs[(*count)++] =
                (struct house_struct){.name = tl_copy_string(name), .path = house->files[i].path};
        }
        free(text);
        free(path);
    }
    if (structs)
        qsort(structs, *count, sizeof *structs, by_name);
    return structs;
}

void house_structs_release(struct house_struct **structs, size_t count)
{
    for (size_t i = 0; i < count; i++)
        free((*structs)[i].name);
    free(*structs);
    *structs = NULL;
}
