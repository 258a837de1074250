#include "config/base/file.h"

#include "config/base/interrupt.h"
#include "config/base/memory.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define STALE_S         3600
#define MKSTEMP_LETTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"

static bool check_status(const char *path, uint64_t limit, struct stat *status, tl_error *error)
{
    if (path[0] == '\0')
        return tl_fail(error, TL_INPUT, "no file name given: name a file");
    if (stat(path, status) != 0) {
        if (errno == ENOENT || errno == ENOTDIR)
            return tl_fail(error, TL_INPUT, "%s: no such file: check the path", path);
        return tl_fail(error, TL_INPUT, "%s: %s: check the path and its permissions", path, strerror(errno));
    }
    if (S_ISDIR(status->st_mode))
        return tl_fail(error, TL_INPUT, "%s: is a folder: name a file in it", path);
    if (!S_ISREG(status->st_mode))
        return tl_fail(error, TL_INPUT, "%s: is not a regular file: copy its contents to one", path);
    if (status->st_size == 0)
        return tl_fail(error, TL_INPUT, "%s: is empty: write or fetch it again", path);
    if ((uint64_t)status->st_size > limit)
        return tl_fail(error, TL_INPUT, "%s: is larger than %llu MiB: make it smaller", path,
                       (unsigned long long)(limit >> 20));
    return true;
}

bool tl_file_check(const char *path, tl_error *error)
{
    struct stat status;
    if (!check_status(path, TL_LIMIT_FILE_BYTES, &status, error))
        return false;
    if (access(path, R_OK) != 0)
        return tl_fail(error, TL_INPUT, "%s: %s: make it readable", path, strerror(errno));
    return true;
}

bool tl_file_exists(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0;
}

bool tl_file_is_same(const char *a, const char *b)
{
    struct stat first, second;
    return stat(a, &first) == 0 && stat(b, &second) == 0 && S_ISREG(first.st_mode) &&
           first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

size_t tl_file_size(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 ? (size_t)status.st_size : 0;
}

bool tl_file_read(const char *path, char **data, size_t *size, tl_error *error)
{
    return tl_file_read_small(path, TL_LIMIT_FILE_BYTES, data, size, error);
}

bool tl_file_read_small(const char *path, size_t limit, char **data, size_t *size, tl_error *error)
{
    struct stat status = {0};
    if (!check_status(path, limit, &status, error) ||
        !tl_memory_request(path, (uint64_t)status.st_size, error))
        return false;
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return tl_fail(error, TL_INPUT, "%s: %s: make it readable", path, strerror(errno));
    size_t expected = (size_t)status.st_size;
    char *bytes = tl_alloc(expected + 1, 1);
    size_t got = fread(bytes, 1, expected, stream);
    fclose(stream);
    if (got != expected) {
        free(bytes);
        return tl_fail(error, TL_INPUT, "%s: only %zu of %zu bytes could be read: check the disk", path, got,
                       expected);
    }
    *data = bytes;
    *size = expected;
    return true;
}

static void release(struct tl_writer *writer)
{
    if (writer->stream)
        fclose(writer->stream);
    free(writer->path);
    free(writer->temporary);
    *writer = (struct tl_writer){0};
}

/* /dev/null and its like must not be replaced by a renamed file. */
static bool is_device(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

/* Removes temporary files of `path` that a killed process left: those that nobody has written to for an hour.
 */
static void sweep(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    char *folder = slash ? tl_format("%.*s/", (int)(slash - path), path) : tl_copy_string("./");
    size_t length = strlen(name);
    DIR *entries = opendir(folder);
    for (struct dirent *entry; entries && (entry = readdir(entries));) {
        struct stat status;
        const char *end = entry->d_name + length;
        if (strncmp(entry->d_name, name, length) != 0 || end[0] != '.' ||
            strspn(end + 1, MKSTEMP_LETTERS) != 6 || strcmp(end + 7, ".tmp") != 0)
            continue;
        char *left = tl_format("%s%s", folder, entry->d_name);
        if (lstat(left, &status) == 0 && S_ISREG(status.st_mode) && time(NULL) - status.st_mtime > STALE_S)
            unlink(left);
        free(left);
    }
    if (entries)
        closedir(entries);
    free(folder);
}

bool tl_writer_begin(struct tl_writer *writer, const char *path, tl_error *error)
{
    *writer = (struct tl_writer){0};
    struct stat status;
    if (path[0] == '\0')
        return tl_fail(error, TL_OUTPUT, "no output file named: give one with -o");
    if (stat(path, &status) == 0 && S_ISDIR(status.st_mode))
        return tl_fail(error, TL_OUTPUT, "%s: is a folder: name a file in it", path);
    char *target = realpath(path, NULL); /* of a symbolic link the file that it names is replaced */
    writer->path = target ? target : tl_copy_string(path);
    if (is_device(path)) {
        writer->temporary = tl_copy_string(path);
        writer->stream = fopen(path, "wb");
    } else {
        sweep(writer->path);
        writer->temporary = tl_format("%s.XXXXXX.tmp", writer->path);
        int descriptor = mkstemps(writer->temporary, 4);
        if (descriptor >= 0) {
            tl_interrupt_guard(writer->temporary); /* first, because fdopen may end the program */
            mode_t mask = umask(0);
            umask(mask);
            fchmod(descriptor,
                   0666 & ~mask); /* mkstemps makes private files; the result should be an ordinary one */
            writer->stream = fdopen(descriptor, "wb");
        }
    }
    if (!writer->stream) {
        int reason = errno;
        tl_writer_abandon(writer);
        return tl_fail(error, TL_OUTPUT,
                       "%s: cannot be written: %s: choose a folder that exists and is writable", path,
                       strerror(reason));
    }
    return true;
}

void tl_writer_close_stream(struct tl_writer *writer)
{
    if (writer->stream)
        fclose(writer->stream);
    writer->stream = NULL;
}

void tl_writer_abandon(struct tl_writer *writer)
{
    if (!writer->temporary)
        return;
    if (strcmp(writer->temporary, writer->path) != 0) {
        unlink(writer->temporary);
        tl_interrupt_unguard(writer->temporary);
    }
    release(writer);
}

bool tl_writer_commit(struct tl_writer *writer, tl_error *error)
{
    bool device = strcmp(writer->temporary, writer->path) == 0;
    FILE *stream = writer->stream ? writer->stream : fopen(writer->temporary, "rb+");
    writer->stream = NULL;
    errno = 0;
    /* Flushed first even after an error, because what is left to write meets the same reason again: errno
     * names it. */
    bool written = stream && fflush(stream) == 0 && !ferror(stream);
    if (written && !device)
        written = fsync(fileno(stream)) == 0;
    int reason = errno;
    if (stream && fclose(stream) != 0 && written) {
        written = false;
        reason = errno;
    }
    if (written && !device && rename(writer->temporary, writer->path) != 0) {
        written = false;
        reason = errno;
    }
    if (!written) {
        tl_fail(error, TL_OUTPUT,
                "%s: could not be written whole: %s: free some space or choose another place", writer->path,
                reason ? strerror(reason) : "write error");
        tl_writer_abandon(writer);
        return false;
    }
    tl_interrupt_unguard(writer->temporary);
    release(writer);
    return true;
}

bool tl_folder_make(const char *path, tl_error *error)
{
    if (path[0] == '\0')
        return tl_fail(error, TL_OUTPUT, "no output folder named: give one with -o");
    char *copy = tl_copy_string(path);
    bool made = true;
    for (char *c = copy + 1; made && *c; c++)
        if (*c == '/') {
            *c = '\0';
            made = mkdir(copy, 0777) == 0 || errno == EEXIST;
            *c = '/';
        }
    made = made && (mkdir(copy, 0777) == 0 || errno == EEXIST);
    int reason = errno;
    free(copy);
    struct stat status;
    if (made && (stat(path, &status) != 0 || !S_ISDIR(status.st_mode)))
        return tl_fail(error, TL_OUTPUT, "%s: is a file, not a folder: choose another name", path);
    if (!made)
        return tl_fail(error, TL_OUTPUT, "%s: folder cannot be made: %s: choose another place", path,
                       strerror(reason));
    return true;
}

char *tl_path_relative_to(const char *base_file, const char *relative)
{
    const char *slash = base_file ? strrchr(base_file, '/') : NULL;
    if (relative[0] == '/' || !slash)
        return tl_copy_string(relative);
    return tl_format("%.*s%s", (int)(slash - base_file + 1), base_file, relative);
}

static bool outside_is_allowed;

void tl_path_allow_outside(void)
{
    outside_is_allowed = true;
}

/* The real path of the folder that holds `path`; NULL where there is none. */
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? tl_format("%.*s", (int)(slash - path + 1), path) : tl_copy_string(".");
    char *real = realpath(folder, NULL);
    free(folder);
    return real;
}

bool tl_path_is_inside(const char *base, const char *path, tl_error *error)
{
    if (outside_is_allowed)
        return true;
    char *folder = folder_of(base), *real = realpath(path, NULL);
    if (!real)
        real = folder_of(path); /* the file is missing: by the folder that it would be in */
    size_t length = folder ? strlen(folder) : 0;
    bool is_root = length == 1;
    bool inside = !real || (folder && strncmp(real, folder, length) == 0 &&
                            (is_root || real[length] == '/' || real[length] == '\0'));
    free(folder);
    free(real);
    return inside ||
           tl_fail(error, TL_INPUT,
                   "%s: lies outside the folder of %s, which names it: copy it there, or allow it with "
                   "--allow-outside",
                   path, base);
}

bool tl_path_has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot + 1, extension) == 0;
}
