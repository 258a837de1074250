#include "config/cache/cache.h"

#include "config/base/file.h"
#include "config/base/hash.h"
#include "config/base/log.h"
#include "config/base/memory.h"

#include <dirent.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define EXTENSION "drape"
#define MAGIC     "toiledrp"

static struct {
    char *folder; /* NULL: no cache */
    uint64_t limit_bytes;
} used;

char *tl_cache_folder(void)
{
    const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    if (cache && cache[0] == '/') /* the XDG specification ignores relative paths */
        return tl_format("%s/toile/drapes", cache);
    return home && home[0] == '/' ? tl_format("%s/.cache/toile/drapes", home) : NULL;
}

void tl_cache_use(const char *folder, uint64_t limit_bytes)
{
    free(used.folder);
    used.folder = folder ? tl_copy_string(folder) : NULL;
    used.limit_bytes = limit_bytes;
}

bool tl_cache_is_used(void)
{
    return used.folder != NULL;
}

/* ---- Keys ---- */

/* Two hashes that begin differently, so that one accidental collision is not enough. */
struct tl_cache_key tl_cache_key_begin(void)
{
    return (struct tl_cache_key){{TL_HASH_START, TL_HASH_START * 31 + 1}};
}

void tl_cache_key_add(struct tl_cache_key *key, const void *bytes, size_t size)
{
    for (int i = 0; i < 2; i++) {
        key->words[i] = tl_hash(key->words[i], &size, sizeof size);
        key->words[i] = tl_hash_words(key->words[i], bytes, size);
    }
}

static char *path_of(const struct tl_cache_key *key)
{
    return tl_format("%s/%016" PRIx64 "%016" PRIx64 "." EXTENSION, used.folder, key->words[0], key->words[1]);
}

/* ---- Files ---- */

/* Before the data. */
struct drape_header {
    char magic[8];
    struct tl_cache_key key;
    uint64_t size, checksum;
};

static bool is_intact(const struct tl_cache_key *key, const char *file, size_t size)
{
    struct drape_header header;
    if (size < sizeof header)
        return false;
    memcpy(&header, file, sizeof header);
    return memcmp(header.magic, MAGIC, sizeof header.magic) == 0 && header.key.words[0] == key->words[0] &&
           header.key.words[1] == key->words[1] && header.size == size - sizeof header &&
           header.checksum == tl_hash_words(TL_HASH_START, file + sizeof header, size - sizeof header);
}

/* Through one descriptor, so that a file that is replaced meanwhile is read whole, as it was. NULL: it cannot
 * be read; *found: there is one. */
static char *read_file(const char *path, size_t *size, bool *found)
{
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    struct stat status;
    char *data = NULL;
    *found = descriptor >= 0;
    if (!*found)
        return NULL;
    if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0 &&
        (uint64_t)status.st_size <= used.limit_bytes + sizeof(struct drape_header)) {
        size_t length = 0;
        ssize_t got = 1;
        *size = (size_t)status.st_size;
        data = tl_alloc(*size, 1);
        while (length < *size && (got = read(descriptor, data + length, *size - length)) > 0)
            length += (size_t)got;
        *size = length; /* a shorter one fails its check */
    }
    close(descriptor);
    return data;
}

/* The bytes of an intact file, header and data; NULL: there is none. */
static char *load_file(const struct tl_cache_key *key, size_t *file_size)
{
    if (!used.folder)
        return NULL;
    bool found;
    char *path = path_of(key), *file = read_file(path, file_size, &found);
    bool intact = file && is_intact(key, file, *file_size);
    if (intact) {
        utimensat(AT_FDCWD, path, NULL, 0); /* used now: it is the last to be removed */
    } else if (found) {
        tl_info("%s: is damaged: it is removed from the cache", path);
        unlink(path);
    }
    if (!intact) {
        free(file);
        file = NULL;
    }
    free(path);
    return file;
}

bool tl_cache_load(const struct tl_cache_key *key, void **data, size_t *size)
{
    size_t file_size = 0;
    char *file = load_file(key, &file_size);
    if (!file)
        return false;
    *size = file_size - sizeof(struct drape_header);
    *data = tl_alloc(*size, 1);
    memcpy(*data, file + sizeof(struct drape_header), *size);
    free(file);
    return true;
}

bool tl_cache_read(const struct tl_cache_key *key, void *data, size_t size)
{
    size_t file_size = 0;
    char *file = load_file(key, &file_size);
    bool fits = file && file_size == sizeof(struct drape_header) + size;
    if (fits)
        memcpy(data, file + sizeof(struct drape_header), size);
    free(file);
    return fits;
}

static bool is_entry(const char *name)
{
    return tl_path_has_extension(name, EXTENSION);
}

static int compare_used(const void *a, const void *b)
{
    const struct timespec *x = &((const struct tl_cache_entry *)a)->used,
                          *y = &((const struct tl_cache_entry *)b)->used;
    if (x->tv_sec != y->tv_sec)
        return x->tv_sec > y->tv_sec ? -1 : 1;
    return (x->tv_nsec < y->tv_nsec) - (x->tv_nsec > y->tv_nsec);
}

struct tl_cache_entry *tl_cache_list(const char *folder, size_t *count)
{
    struct tl_cache_entry *entries = NULL;
    DIR *directory = opendir(folder);
    *count = 0;
    for (struct dirent *item; directory && (item = readdir(directory));) {
        struct stat status;
        struct tl_cache_entry entry;
        if (!is_entry(item->d_name) || strlen(item->d_name) >= sizeof entry.name ||
            fstatat(dirfd(directory), item->d_name, &status, 0) != 0)
            continue;
        entry = (struct tl_cache_entry){.bytes = (uint64_t)status.st_size, .used = status.st_mtim};
        strcpy(entry.name, item->d_name);
        entries = tl_resize(entries, *count + 1, sizeof *entries);
        entries[(*count)++] = entry;
    }
    if (directory)
        closedir(directory);
    if (*count > 0)
        qsort(entries, *count, sizeof *entries, compare_used);
    return entries;
}

/* Another process may remove the same file at the same time: it is gone either way. */
static bool remove_entry(const char *folder, const char *name)
{
    char *path = tl_format("%s/%s", folder, name);
    bool removed = unlink(path) == 0;
    free(path);
    return removed;
}

static void keep_limit(void)
{
    size_t count;
    struct tl_cache_entry *entries = tl_cache_list(used.folder, &count);
    uint64_t bytes = 0;
    for (size_t i = 0; i < count; i++) {
        bytes += entries[i].bytes;
        if (bytes > used.limit_bytes)
            remove_entry(used.folder, entries[i].name);
    }
    free(entries);
}

void tl_cache_store(const struct tl_cache_key *key, const void *data, size_t size)
{
    if (!used.folder || size > used.limit_bytes)
        return;
    struct drape_header header = {
        .key = *key, .size = size, .checksum = tl_hash_words(TL_HASH_START, data, size)};
    memcpy(header.magic, MAGIC, sizeof header.magic);
    char *path = path_of(key);
    struct tl_writer writer = {0};
    tl_error error;
    bool stored = tl_folder_make(used.folder, &error) && tl_writer_begin(&writer, path, &error);
    if (stored) {
        fwrite(&header, sizeof header, 1, writer.stream);
        fwrite(data, 1, size, writer.stream);
        stored = tl_writer_commit(&writer, &error);
    }
    if (stored)
        keep_limit();
    else
        tl_debug("cache: %s", error.message);
    free(path);
}

size_t tl_cache_clear(const char *folder)
{
    size_t count, removed = 0;
    struct tl_cache_entry *entries = tl_cache_list(folder, &count);
    for (size_t i = 0; i < count; i++)
        removed += remove_entry(folder, entries[i].name);
    free(entries);
    return removed;
}
