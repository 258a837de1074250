#include "tests/hygiene/sources.h"

#include "config/base/file.h"
#include "config/base/memory.h"
#include "tests/hygiene/house.h"

#include <ctype.h>
#include <dirent.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const endings[] = {".c",    ".h",  ".cpp", ".glsl", ".vert",  ".frag", ".comp",
                                      ".yaml", ".md", ".sh",  ".py",   ".cmake", ".txt"};

static struct sources *reading; /* nftw hands its callback nothing of the caller's */
static const char *reading_root;

static bool is_text(const char *path)
{
    for (size_t i = 0; i < TL_COUNT(endings); i++)
        if (house_ends_with(path, endings[i]))
            return true;
    return false;
}

/* Length of the mark that a continued line of a comment begins with, blanks included. */
static size_t mark_length(const char *line)
{
    size_t blanks = strspn(line, " \t");
    const char *mark = line + blanks;
    size_t length = 0;
    if (mark[0] == '*' && mark[1] != '/')
        length = 1;
    else if (mark[0] == '/' && mark[1] == '/')
        length = 2;
    else if (mark[0] == '#' && (mark[1] == ' ' || mark[1] == '\n'))
        length = 1;
    mark += length;
    return (size_t)(mark - line) + strspn(mark, " \t");
}

char *sources_join(const char *path, const char *text, size_t **lines)
{
    size_t size = strlen(text), count = 0, line = 1;
    char *joined = tl_alloc(size + 1, 1);
    bool is_page = house_ends_with(path, ".md") || house_ends_with(path, ".txt");
    *lines = tl_alloc(size + 1, sizeof **lines);
    for (const char *at = text; *at;) {
        if (*at == '\n') {
            line++;
            at++;
            if (!is_page)
                at += mark_length(at);
            /* "one string " "in two parts" */
            bool is_string = count > 0 && joined[count - 1] == '"' && *at == '"';
            if (is_string) {
                count--;
                at++;
                continue;
            }
            joined[count] = ' ';
        } else
            joined[count] = *at++;
        (*lines)[count++] = line;
    }
    joined[count] = '\0';
    return joined;
}

static void add(const char *full)
{
    struct source file = {.path = tl_copy_string(full + strlen(reading_root) + 1)};
    size_t size = 0;
    tl_error error = {0};
    if (!tl_file_read(full, &file.text, &size, &error)) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
    file.joined = sources_join(file.path, file.text, &file.lines);
    reading->files = tl_resize(reading->files, reading->count + 1, sizeof *reading->files);
    reading->files[reading->count++] = file;
}

static int visit(const char *full, const struct stat *status, int type, struct FTW *where)
{
    (void)where;
    bool is_foreign = strstr(full, "/tests/data/") != NULL; /* files of others, and their licences */
    if (type == FTW_F && status->st_size > 0 && is_text(full) && !is_foreign)
        add(full);
    return 0;
}

static int by_path(const void *a, const void *b)
{
    return strcmp(((const struct source *)a)->path, ((const struct source *)b)->path);
}

static void read_folder(const char *name)
{
    char *folder = tl_format("%s/%s", reading_root, name);
    if (nftw(folder, visit, 16, FTW_PHYS) != 0) {
        fprintf(stderr, "%s: cannot be read\n", folder);
        exit(1);
    }
    free(folder);
}

void sources_read(struct sources *sources, const char *root)
{
    *sources = (struct sources){0};
    reading = sources;
    reading_root = root;
    for (size_t i = 0; house_floors[i]; i++)
        read_folder(house_floors[i]);
    read_folder("tests");
    read_folder("docs");
    DIR *folder = opendir(root);
    for (const struct dirent *entry; folder && (entry = readdir(folder)) != NULL;)
        if (house_ends_with(entry->d_name, ".md")) {
            char *full = tl_format("%s/%s", root, entry->d_name);
            add(full);
            free(full);
        }
    if (folder)
        closedir(folder);
    qsort(sources->files, sources->count, sizeof *sources->files, by_path);
}

void sources_release(struct sources *sources)
{
    for (size_t i = 0; i < sources->count; i++) {
        free(sources->files[i].path);
        free(sources->files[i].text);
        free(sources->files[i].joined);
        free(sources->files[i].lines);
    }
    free(sources->files);
    *sources = (struct sources){0};
}
