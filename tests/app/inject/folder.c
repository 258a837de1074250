#include "tests/app/inject/folder.h"

#include "config/base/file.h"
#include "config/base/hash.h"
#include "config/base/memory.h"

#include <cjson/cJSON.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* nftw calls back without an argument. */
static struct known_files *listed;
static size_t root_length;

static int list_file(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status, (void)place;
    if (kind != FTW_F)
        return 0;
    char *data = NULL;
    size_t size = 0;
    tl_error error;
    if (tl_file_size(path) > 0 && !tl_file_read(path, &data, &size, &error))
        return 0;
    listed->files = tl_resize(listed->files, listed->count + 1, sizeof *listed->files);
    listed->files[listed->count++] = (struct known_file){.path = tl_copy_string(path + root_length + 1),
                                                         .hash = tl_hash(TL_HASH_START, data, size)};
    free(data);
    return 0;
}

void known_add_all(struct known_files *known, const char *folder, enum known_when when)
{
    size_t before = known->count;
    listed = known;
    root_length = strlen(folder);
    nftw(folder, list_file, 16, FTW_PHYS);
    for (size_t i = before; i < known->count; i++)
        known->files[i].when = when;
}

void known_add(struct known_files *known, const char *folder, const char *file, const char *path)
{
    char *from = tl_format("%s/%s", folder, file);
    size_t before = known->count;
    listed = known;
    root_length = strlen(folder);
    list_file(from, NULL, FTW_F, NULL);
    free(from);
    if (known->count == before)
        return;
    free(known->files[before].path);
    known->files[before].path = tl_copy_string(path);
    known->files[before].when = KNOWN_BETWEEN;
}

void known_release(struct known_files *known)
{
    for (size_t i = 0; i < known->count; i++)
        free(known->files[i].path);
    free(known->files);
    *known = (struct known_files){0};
}

static int ends_in(const char *text, size_t size, const char *end)
{
    size_t length = strlen(end);
    return size >= length && memcmp(text + size - length, end, length) == 0;
}

/* Whether a file that depends on what was refused, such as a table of what could not be drawn, is whole. */
static int is_whole(const char *folder, const char *name)
{
    char *path = tl_format("%s/%s", folder, name), *text = NULL;
    size_t size = 0;
    tl_error error;
    int whole = 0;
    if (tl_file_read(path, &text, &size, &error)) {
        cJSON *json = tl_path_has_extension(path, "json") ? cJSON_Parse(text) : NULL;
        whole = json || (tl_path_has_extension(path, "html") && ends_in(text, size, "</html>\n")) ||
                (tl_path_has_extension(path, "csv") && ends_in(text, size, "\n")) ||
                (tl_path_has_extension(path, "png") && size > 8 && memcmp(text + size - 8, "IEND", 4) == 0);
        cJSON_Delete(json);
    }
    free(text);
    free(path);
    return whole;
}

static int has_path(const struct known_files *known, const char *path, enum known_when when)
{
    for (size_t i = 0; i < known->count; i++)
        if (known->files[i].when == when && strcmp(known->files[i].path, path) == 0)
            return 1;
    return 0;
}

static int has(const struct known_files *known, const struct known_file *file)
{
    for (size_t i = 0; i < known->count; i++)
        if (strcmp(known->files[i].path, file->path) == 0 && known->files[i].hash == file->hash)
            return 1;
    return 0;
}

int known_find_problem(const struct known_files *known, const char *folder, int is_complete, char *problem,
                       size_t size)
{
    struct known_files left = {0};
    problem[0] = '\0';
    known_add_all(&left, folder, KNOWN_AFTER);
    for (size_t i = 0; !problem[0] && i < left.count; i++) {
        const struct known_file *file = &left.files[i];
        if (tl_path_has_extension(file->path, "tmp"))
            snprintf(problem, size, "%s is left", file->path);
        else if (!has(known, file) && !is_whole(folder, file->path))
            snprintf(problem, size, "%s is not whole", file->path);
    }
    for (size_t i = 0; !problem[0] && i < known->count; i++) {
        const struct known_file *file = &known->files[i];
        if (file->when != KNOWN_AFTER || strncmp(file->path, "cache/", 6) == 0)
            continue;
        if (is_complete && !has(&left, file))
            snprintf(problem, size, "%s is not what a complete run writes", file->path);
        else if (has_path(known, file->path, KNOWN_BEFORE) && !has_path(&left, file->path, KNOWN_AFTER))
            snprintf(problem, size, "%s is gone", file->path);
    }
    known_release(&left);
    return problem[0] != '\0';
}
