#include "tests/hygiene/house.h"

#include "config/base/file.h"
#include "config/base/memory.h"

#include <ftw.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const house_floors[] = {"config", "assets", "cloth", "render", "app", NULL};

bool house_starts_with_folder(const char *path, const char *folder)
{
    size_t length = strlen(folder);
    return strncmp(path, folder, length) == 0 && path[length] == '/';
}

bool house_ends_with(const char *text, const char *end)
{
    size_t length = strlen(text), end_length = strlen(end);
    return length >= end_length && strcmp(text + length - end_length, end) == 0;
}

/* ---- Graphs ---- */

void graph_create(struct graph *graph, char *const *names, size_t count)
{
    *graph = (struct graph){.count = count};
    graph->names = tl_alloc(count + 1, sizeof *graph->names);
    graph->arrows = tl_alloc(count * count + 1, sizeof *graph->arrows);
    graph->because = tl_alloc(count * count + 1, sizeof *graph->because);
    for (size_t i = 0; i < count; i++)
        graph->names[i] = tl_copy_string(names[i]);
}

void graph_release(struct graph *graph)
{
    for (size_t i = 0; i < graph->count; i++)
        free(graph->names[i]);
    for (size_t i = 0; i < graph->count * graph->count; i++)
        free(graph->because[i]);
    free(graph->names);
    free(graph->arrows);
    free(graph->because);
    *graph = (struct graph){0};
}

size_t graph_find(const struct graph *graph, const char *name)
{
    size_t i = 0;
    while (i < graph->count && strcmp(graph->names[i], name) != 0)
        i++;
    return i;
}

void graph_add(struct graph *graph, size_t from, size_t to, const char *because)
{
    if (from == to || from >= graph->count || to >= graph->count || graph->arrows[from * graph->count + to])
        return;
    graph->arrows[from * graph->count + to] = true;
    graph->because[from * graph->count + to] = tl_copy_string(because);
}

/* Marks all nodes that `from` reaches by one arrow or more, without entering skipped ones. */
static void mark_reached(const struct graph *graph, size_t from, const bool *skip, bool *reached)
{
    for (size_t to = 0; to < graph->count; to++)
        if (graph->arrows[from * graph->count + to] && !skip[to] && !reached[to]) {
            reached[to] = true;
            mark_reached(graph, to, skip, reached);
        }
}

bool graph_reaches(const struct graph *graph, size_t from, size_t to)
{
    bool *skip = tl_alloc(graph->count + 1, sizeof *skip),
         *reached = tl_alloc(graph->count + 1, sizeof *reached);
    mark_reached(graph, from, skip, reached);
    bool reaches = reached[to];
    free(skip);
    free(reached);
    return reaches;
}

size_t graph_circle(const struct graph *graph, bool *skip, size_t *circle)
{
    size_t size = 0;
    bool *from_here = tl_alloc(graph->count + 1, sizeof *from_here);
    bool *from_there = tl_alloc(graph->count + 1, sizeof *from_there);
    for (size_t i = 0; i < graph->count && size == 0; i++) {
        if (skip[i])
            continue;
        memset(from_here, 0, graph->count * sizeof *from_here);
        mark_reached(graph, i, skip, from_here);
        if (!from_here[i])
            continue;
        for (size_t j = 0; j < graph->count; j++) {
            memset(from_there, 0, graph->count * sizeof *from_there);
            mark_reached(graph, j, skip, from_there);
            if (from_here[j] && from_there[i])
                circle[size++] = j;
        }
        for (size_t j = 0; j < size; j++)
            skip[circle[j]] = true;
    }
    free(from_here);
    free(from_there);
    return size;
}

void graph_heights(const struct graph *graph, int *height)
{
    memset(height, 0, graph->count * sizeof *height);
    for (size_t round = 0; round < graph->count; round++)
        for (size_t i = 0; i < graph->count; i++)
            for (size_t j = 0; j < graph->count; j++)
                if (graph->arrows[i * graph->count + j] && height[i] <= height[j])
                    height[i] = height[j] + 1;
}

/* ---- Files ---- */

static struct house *reading; /* nftw hands its callback nothing of the caller's */
static const char *reading_root;

static void *grown(void *array, size_t count, size_t size)
{
    return tl_resize(array, count + 1, size);
}

static void read_line(struct house_file *file, const char *line, size_t number)
{
    line += strspn(line, " \t");
    if (*line != '#')
        return;
    line++;
    line += strspn(line, " \t");
    if (strncmp(line, "include", 7) != 0)
        return;
    line += 7;
    line += strspn(line, " \t");
    char header[256] = "";
    bool quoted = sscanf(line, "\"%255[^\"]\"", header) == 1;
    if (!quoted && sscanf(line, "<%255[^>]>", header) != 1) {
        free(file->unreadable);
        file->unreadable = tl_format("%zu: %s", number, line);
        return;
    }
    file->includes = grown(file->includes, file->include_count, sizeof *file->includes);
    file->includes[file->include_count++] = (struct house_include){tl_copy_string(header), quoted, number};
}

static char *without(const char *path, char stop)
{
    const char *end = strrchr(path, stop);
    return tl_format("%.*s", end ? (int)(end - path) : 0, path);
}

static int visit(const char *full, const struct stat *status, int type, struct FTW *where)
{
    (void)status;
    (void)where;
    if (type != FTW_F ||
        (!house_ends_with(full, ".c") && !house_ends_with(full, ".h") && !house_ends_with(full, ".cpp")))
        return 0;
    const char *path = full + strlen(reading_root) + 1;
    struct house_file file = {
        .path = tl_copy_string(path), .room = without(path, '/'), .pair = without(path, '.')};
    char *data = NULL;
    size_t size = 0;
    tl_error error = {0};
    if (!tl_file_read(full, &data, &size, &error)) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
    char *rest = data;
    for (char *line; (line = strsep(&rest, "\n")) != NULL && (rest || *line);)
        read_line(&file, line, ++file.line_count);
    free(data);
    reading->files = grown(reading->files, reading->file_count, sizeof *reading->files);
    reading->files[reading->file_count++] = file;
    return 0;
}

static int by_path(const void *a, const void *b)
{
    return strcmp(((const struct house_file *)a)->path, ((const struct house_file *)b)->path);
}

static void read_folder(struct house *house, const char *root, const char *name)
{
    size_t before = house->file_count;
    char *folder = tl_format("%s/%s", root, name);
    reading = house;
    reading_root = root;
    if (nftw(folder, visit, 16, FTW_PHYS) != 0) {
        fprintf(stderr, "%s: cannot be read\n", folder);
        exit(1);
    }
    free(folder);
    qsort(house->files + before, house->file_count - before, sizeof *house->files, by_path);
}

/* One node for each different name. */
static void create_nodes(struct graph *graph, const struct house *house, bool headers_only,
                         char *(*name)(const struct house_file *))
{
    char **names = tl_alloc(house->own_count + 1, sizeof *names);
    size_t count = 0;
    for (size_t i = 0; i < house->own_count; i++) {
        if (headers_only && !house_ends_with(house->files[i].path, ".h"))
            continue;
        char *candidate = name(&house->files[i]);
        bool is_new = true;
        for (size_t j = 0; j < count; j++)
            is_new = is_new && strcmp(names[j], candidate) != 0;
        if (is_new)
            names[count++] = candidate;
    }
    graph_create(graph, names, count);
    free(names);
}

static char *path_of(const struct house_file *file)
{
    return file->path;
}

static char *pair_of(const struct house_file *file)
{
    return file->pair;
}

static char *room_of(const struct house_file *file)
{
    return file->room;
}

static void add_includes(struct house *house)
{
    for (size_t i = 0; i < house->own_count; i++) {
        const struct house_file *file = &house->files[i];
        for (size_t j = 0; j < file->include_count; j++) {
            const struct house_include *include = &file->includes[j];
            if (!include->quoted)
                continue;
            char *because = tl_format("%s:%zu: #include \"%s\"", file->path, include->line, include->header);
            char *room = without(include->header, '/');
            graph_add(&house->rooms, graph_find(&house->rooms, file->room), graph_find(&house->rooms, room),
                      because);
            graph_add(&house->headers, graph_find(&house->headers, file->path),
                      graph_find(&house->headers, include->header), because);
            free(room);
            free(because);
        }
    }
}

void house_read(struct house *house, const char *root)
{
    *house = (struct house){0};
    for (size_t i = 0; house_floors[i]; i++)
        read_folder(house, root, house_floors[i]);
    house->own_count = house->file_count;
    read_folder(house, root, "tests");
    create_nodes(&house->pairs, house, false, pair_of);
    create_nodes(&house->headers, house, true, path_of);
    create_nodes(&house->rooms, house, false, room_of);
    add_includes(house);
}

/* ---- Linked symbols ---- */

struct symbol {
    char *name;
    size_t pair;
};

static int by_name(const void *a, const void *b)
{
    return strcmp(((const struct symbol *)a)->name, ((const struct symbol *)b)->name);
}

/* "ROOT/cloth/CMakeFiles/toile_cloth.dir/mesh/rigid.c.o" and
 * "ROOT/app/lab/CMakeFiles/toile_lab.dir/check/check.c.o" -> the pairs cloth/mesh/rigid and
 * app/lab/check/check; `count` if it is none. */
static size_t pair_of_object(const struct house *house, const char *object, const char *root)
{
    const char *path = object + strlen(root) + 1, *inner = strstr(path, ".dir/");
    const char *target = strstr(path, "/CMakeFiles/");
    size_t pair = house->pairs.count;
    if (inner && target) {
        char *name = tl_format("%.*s/%s", (int)(target - path), path, inner + strlen(".dir/"));
        char *without_o = without(name, '.'), *without_c = without(without_o, '.');
        pair = graph_find(&house->pairs, without_c);
        free(without_c);
        free(without_o);
        free(name);
    }
    return pair;
}

void house_read_objects(struct house *house, const char *list, const char *root)
{
    struct symbol *defined = NULL, *used = NULL;
    size_t defined_count = 0, used_count = 0;
    char *command = tl_format("sed 's:/\\./:/:; s/.*/\"&\"/' '%s' | xargs nm -A -g -P", list);
    FILE *lines = popen(command, "r");
    char object[PATH_MAX], name[1024], kind;
    char *line = NULL;
    size_t capacity = 0;
    /* PATH: NAME KIND VALUE SIZE */
    while (lines && getline(&line, &capacity, lines) > 0) {
        if (sscanf(line, "%4095[^:]: %1023s %c", object, name, &kind) != 3)
            continue;
        struct symbol symbol = {NULL, pair_of_object(house, object, root)};
        /* Weak and common ones are C++'s inline functions: nobody's. */
        if (symbol.pair == house->pairs.count || !strchr("UTDBRS", kind))
            continue;
        symbol.name = tl_copy_string(name);
        struct symbol **known = kind == 'U' ? &used : &defined;
        size_t *count = kind == 'U' ? &used_count : &defined_count;
        *known = grown(*known, *count, sizeof **known);
        (*known)[(*count)++] = symbol;
    }
    if (!lines || pclose(lines) != 0 || defined_count == 0) {
        fprintf(stderr,
                "%s: its object files cannot be read: build toile and toile_library, and install binutils\n",
                list);
        exit(1);
    }
    free(line);
    free(command);
    qsort(defined, defined_count, sizeof *defined, by_name);
    for (size_t i = 0; i < used_count; i++) {
        const struct symbol *found = bsearch(&used[i], defined, defined_count, sizeof *defined, by_name);
        if (!found)
            continue; /* a library's */
        const char *from = house->pairs.names[used[i].pair], *to = house->pairs.names[found->pair];
        char *because = tl_format("%s uses %s of %s", from, found->name, to);
        char *from_room = without(from, '/'), *to_room = without(to, '/');
        graph_add(&house->pairs, used[i].pair, found->pair, because);
        graph_add(&house->rooms, graph_find(&house->rooms, from_room), graph_find(&house->rooms, to_room),
                  because);
        free(from_room);
        free(to_room);
        free(because);
    }
    for (size_t i = 0; i < defined_count; i++)
        free(defined[i].name);
    for (size_t i = 0; i < used_count; i++)
        free(used[i].name);
    free(defined);
    free(used);
}

void house_release(struct house *house)
{
    for (size_t i = 0; i < house->file_count; i++) {
        struct house_file *file = &house->files[i];
        for (size_t j = 0; j < file->include_count; j++)
            free(file->includes[j].header);
        free(file->includes);
        free(file->unreadable);
        free(file->path);
        free(file->room);
        free(file->pair);
    }
    free(house->files);
    graph_release(&house->pairs);
    graph_release(&house->headers);
    graph_release(&house->rooms);
    *house = (struct house){0};
}
