#include "assets/fabric/fabric_file.h"

#include "assets/fabric/fabric_internal.h"
#include "config/base/file.h"
#include "config/base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

bool tl_fabric_file_is(const char *path)
{
    return tl_path_has_extension(path, "u3m") || tl_path_has_extension(path, "json") ||
           tl_store_is_archive(path) || is_folder(path);
}

/* The folder that holds a file, "." for a name alone. */
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash == path ? tl_copy_string("/")
           : slash       ? tl_format("%.*s", (int)(slash - path), path)
                         : tl_copy_string(".");
}

/* The last part of the path, without its extension. */
static void name_after(tl_fabric_file *file, const char *path)
{
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/')
        length--;
    char *trimmed = tl_format("%.*s", (int)length, path), *slash = strrchr(trimmed, '/');
    char *base = slash && slash[1] ? slash + 1 : trimmed, *dot = is_folder(path) ? NULL : strrchr(base, '.');
    if (dot && dot != base)
        *dot = '\0';
    tl_fabric_set_name(file, base);
    free(trimmed);
}

/* The archive's only .u3m file; NULL: it has none. Fails when there are several. */
static bool find_u3m(const tl_store *store, const char **out, tl_error *error)
{
    *out = NULL;
    for (size_t i = 0; i < store->count; i++) {
        if (!tl_path_has_extension(store->names[i], "u3m"))
            continue;
        if (*out)
            return tl_fail(error, TL_INPUT, "%s: holds several fabrics, \"%s\" and \"%s\": expected one",
                           store->path, *out, store->names[i]);
        *out = store->names[i];
    }
    return true;
}

static bool read_archive(tl_fabric_file *file, const char *path, tl_error *error)
{
    const char *inner;
    if (!tl_store_open(path, &file->store, error) || !find_u3m(&file->store, &inner, error))
        return false;
    if (inner)
        return tl_u3m_read(file, inner, error);
    if (tl_path_has_extension(path, "u3ma"))
        return tl_fail(error, TL_INPUT, "%s: holds no .u3m file: write the archive again", path);
    return tl_map_names_read(file, error);
}

static bool read_single(tl_fabric_file *file, const char *path, tl_error *error)
{
    const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
    if (!tl_file_check(path, error))
        return false;
    file->store =
        (tl_store){.path = folder_of(path)}; /* its pictures are named by the file: no list is needed */
    return tl_path_has_extension(path, "u3m") ? tl_u3m_read(file, base, error)
                                              : tl_fab_read(file, base, "", error);
}

static bool read_folder(tl_fabric_file *file, const char *path, tl_error *error)
{
    const char *inner;
    if (!tl_store_open(path, &file->store, error) || !find_u3m(&file->store, &inner, error))
        return false;
    return inner ? tl_u3m_read(file, inner, error) : tl_map_names_read(file, error);
}

bool tl_fabric_file_open(const char *path, tl_fabric_file *out, tl_error *error)
{
    *out =
        (tl_fabric_file){.surface = {.colour = {1, 1, 1}, .roughness = 0.7f, .specular = 0.04f, .alpha = 1},
                         .physics = {NAN, NAN, NAN, NAN, NAN, NAN, NAN}};
    name_after(out, path);
    bool read = is_folder(path)             ? read_folder(out, path, error)
                : tl_store_is_archive(path) ? read_archive(out, path, error)
                                            : read_single(out, path, error);
    if (!read)
        tl_fabric_file_release(out);
    return read;
}

void tl_fabric_file_release(tl_fabric_file *file)
{
    tl_store_close(&file->store);
    for (int use = 0; use < TL_PICTURE_USES; use++)
        free(file->pictures[use].file);
    free(file->back_picture.file);
    for (size_t i = 0; i < file->field_count; i++) {
        free(file->fields[i].name);
        free(file->fields[i].value);
        free(file->fields[i].use);
    }
    free(file->fields);
    for (size_t i = 0; i < file->missing_count; i++)
        free(file->missing[i]);
    free(file->missing);
    *file = (tl_fabric_file){0};
}
