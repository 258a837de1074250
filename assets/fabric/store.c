#include "assets/fabric/store.h"

#include "config/base/file.h"
#include "config/base/memory.h"

#include <zip.h>

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Deflate compresses at most 1032:1. The constant leaves room for a header of a few bytes. */
#define RATIO_MAX   1032
#define RATIO_BYTES 1024

bool tl_store_is_archive(const char *path)
{
    return tl_path_has_extension(path, "u3ma") || tl_path_has_extension(path, "zip");
}

char *tl_store_place(const tl_store *store, const char *name)
{
    size_t length = strlen(store->path);
    bool slash = length > 0 && store->path[length - 1] == '/';
    return tl_format("%s%s%s", store->path, slash ? "" : "/", name);
}

static bool is_step(const char *part, size_t length)
{
    return (length == 1 && part[0] == '.') || (length == 2 && part[0] == '.' && part[1] == '.');
}

/* Whether a name stays within the store: no root, no drive, no step upwards, no empty part but a folder's
 * last. */
static bool stays_inside(const char *name)
{
    if (name[0] == '\0' || strchr(name, '\\') || strchr(name, ':'))
        return false;
    for (const char *part = name;;) {
        size_t length = strcspn(part, "/");
        bool is_last = part[length] == '\0';
        if (is_step(part, length) || (length == 0 && !is_last))
            return false;
        if (is_last)
            return true;
        part += length + 1;
    }
}

static bool check_name(const tl_store *store, const char *name, tl_error *error)
{
    return stays_inside(name) ||
           tl_fail(error, TL_INPUT, "%s: \"%s\" leads out of it: expected a relative path without \"..\"",
                   store->path, name);
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static void add_name(tl_store *store, const char *name)
{
    store->names = tl_resize(store->names, store->count + 1, sizeof *store->names);
    store->names[store->count++] = tl_copy_string(name);
}

static bool fail_count(const tl_store *store, tl_error *error)
{
    return tl_fail(error, TL_INPUT, "%s: holds more than %d files: name a folder or archive of one fabric",
                   store->path, TL_LIMIT_STORE_FILES);
}

static bool is_file_in(const tl_store *store, const char *name)
{
    struct stat status;
    char *path = tl_store_place(store, name);
    bool is_file = stat(path, &status) == 0 && S_ISREG(status.st_mode);
    free(path);
    return is_file;
}

static bool open_folder(tl_store *store, tl_error *error)
{
    DIR *folder = opendir(store->path);
    if (!folder)
        return tl_fail(error, TL_INPUT, "%s: the folder cannot be read: %s", store->path, strerror(errno));
    bool good = true;
    for (const struct dirent *entry; good && (entry = readdir(folder));) {
        good = store->count < TL_LIMIT_STORE_FILES || fail_count(store, error);
        if (good && entry->d_name[0] != '.' && is_file_in(store, entry->d_name))
            add_name(store, entry->d_name);
    }
    closedir(folder);
    return good;
}

static bool open_archive(tl_store *store, tl_error *error)
{
    int code = 0;
    if (!tl_file_check(store->path, error))
        return false;
    store->zip = zip_open(store->path, ZIP_RDONLY | ZIP_CHECKCONS, &code);
    if (!store->zip) {
        zip_error_t why;
        zip_error_init_with_code(&why, code);
        tl_fail(error, TL_INPUT, "%s: is no sound zip archive (%s): fetch or write it again", store->path,
                zip_error_strerror(&why));
        zip_error_fini(&why);
        return false;
    }
    zip_int64_t count = zip_get_num_entries(store->zip, 0);
    if (count > TL_LIMIT_STORE_FILES)
        return fail_count(store, error);
    for (zip_int64_t i = 0; i < count; i++) {
        const char *name = zip_get_name(store->zip, (zip_uint64_t)i, 0);
        if (!name)
            return tl_fail(error, TL_INPUT, "%s: a name in the archive cannot be read", store->path);
        if (!check_name(store, name, error))
            return false;
        if (name[strlen(name) - 1] != '/')
            add_name(store, name);
    }
    return true;
}

bool tl_store_open(const char *path, tl_store *out, tl_error *error)
{
    *out = (tl_store){.path = tl_copy_string(path)};
    bool opened = tl_store_is_archive(path) ? open_archive(out, error) : open_folder(out, error);
    if (!opened) {
        tl_store_close(out);
        return false;
    }
    if (out->count)
        qsort(out->names, out->count, sizeof *out->names, compare_names);
    return true;
}

void tl_store_close(tl_store *store)
{
    if (store->zip)
        zip_discard(store->zip);
    for (size_t i = 0; i < store->count; i++)
        free(store->names[i]);
    free(store->names);
    free(store->path);
    *store = (tl_store){0};
}

/* Checks an entry's sizes, which its archive states, before memory is taken for it. */
static bool check_entry(const tl_store *store, const char *name, const zip_stat_t *entry, size_t limit,
                        tl_error *error)
{
    zip_uint64_t needed = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_ENCRYPTION_METHOD;
    if ((entry->valid & needed) != needed)
        return tl_fail(error, TL_INPUT, "%s: \"%s\" states no size: write the archive again", store->path,
                       name);
    if (entry->encryption_method != ZIP_EM_NONE)
        return tl_fail(error, TL_INPUT, "%s: \"%s\" is encrypted: write the archive without a password",
                       store->path, name);
    if (entry->size > limit)
        return tl_fail(error, TL_INPUT, "%s: \"%s\" has %llu bytes: at most %zu are read", store->path, name,
                       (unsigned long long)entry->size, limit);
    if (entry->size > entry->comp_size * RATIO_MAX + RATIO_BYTES)
        return tl_fail(
            error, TL_INPUT,
            "%s: \"%s\" claims %llu bytes out of %llu, more than deflate can hold: the archive is damaged or "
            "a trap",
            store->path, name, (unsigned long long)entry->size, (unsigned long long)entry->comp_size);
    return true;
}

static bool read_entry(const tl_store *store, const char *name, size_t limit, char **data, size_t *size,
                       tl_error *error)
{
    zip_stat_t entry;
    zip_stat_init(&entry);
    if (zip_stat(store->zip, name, 0, &entry) != 0)
        return tl_fail(error, TL_INPUT, "%s: has no file \"%s\"", store->path, name);
    if (!check_entry(store, name, &entry, limit, error))
        return false;
    zip_file_t *file = zip_fopen_index(store->zip, entry.index, 0);
    char *bytes = TL_NEW_ARRAY(char, entry.size + 1);
    zip_int64_t read = file ? zip_fread(file, bytes, entry.size) : -1;
    char extra; /* the end of the file is read too: there the checksum is checked */
    bool whole = read == (zip_int64_t)entry.size && zip_fread(file, &extra, 1) == 0;
    if (!whole)
        tl_fail(error, TL_INPUT, "%s: \"%s\" is damaged (%s): fetch or write the archive again", store->path,
                name, file ? zip_file_strerror(file) : zip_strerror(store->zip));
    if (file)
        zip_fclose(file);
    if (!whole) {
        free(bytes);
        return false;
    }
    *data = bytes;
    *size = entry.size;
    return true;
}

bool tl_store_read(const tl_store *store, const char *name, size_t limit, char **data, size_t *size,
                   tl_error *error)
{
    *data = NULL;
    *size = 0;
    if (!check_name(store, name, error))
        return false;
    if (store->zip)
        return read_entry(store, name, limit, data, size, error);
    char *path = tl_store_place(store, name);
    bool read = tl_file_read_small(path, limit, data, size, error);
    free(path);
    return read;
}

enum tl_store_found tl_store_find(const tl_store *store, const char *name, tl_error *error)
{
    if (!check_name(store, name, error))
        return TL_STORE_REFUSED;
    bool is_there = store->zip ? zip_name_locate(store->zip, name, 0) >= 0 : is_file_in(store, name);
    return is_there ? TL_STORE_FOUND : TL_STORE_MISSING;
}
