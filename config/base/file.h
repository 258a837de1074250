/* Files: whole reads with a size limit, and writes that either appear complete or not at all.
 *
 * A reader refuses directories, missing and empty files with one line. A writer makes `path.XXXXXX.tmp`
 * beside the target, and renames it over the target on commit, after flushing; a full disk or an abandoned
 * write leaves no file behind and the old target untouched. What a killed process left is removed an hour
 * later by the next writer of the same target. A second Ctrl-C and a lack of memory remove the temporary
 * file too (config/base/interrupt.h). Not atomic: writing to a device such as /dev/full or /dev/null, which
 * is written directly. */
#ifndef TOILE_CONFIG_BASE_FILE_H
#define TOILE_CONFIG_BASE_FILE_H

#include "config/base/error.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define TL_LIMIT_FILE_BYTES ((uint64_t)4 << 30) /* larger inputs are refused */

/* Reads a whole file; *data is followed by a NUL that *size does not count; free(*data). */
bool tl_file_read(const char *path, char **data, size_t *size, tl_error *error);

/* The same for files that are small by nature: one of more than `limit` bytes is refused unread. */
bool tl_file_read_small(const char *path, size_t limit, char **data, size_t *size, tl_error *error);

/* Checks that `path` is a readable regular file and not empty (same messages as tl_file_read). */
bool tl_file_check(const char *path, tl_error *error);

bool tl_file_exists(const char *path);
/* Whether two paths name one existing file that is no folder. */
bool tl_file_is_same(const char *a, const char *b);
/* Bytes; 0 for a file that cannot be found. */
size_t tl_file_size(const char *path);

struct tl_writer {
    char *path;      /* final name */
    char *temporary; /* name to write to; libraries that open files themselves use it */
    FILE *stream;    /* open for writing; NULL after tl_writer_close_stream */
};

bool tl_writer_begin(struct tl_writer *writer, const char *path, tl_error *error);
/* Closes the stream but keeps the temporary file, for libraries that open `temporary` themselves. */
void tl_writer_close_stream(struct tl_writer *writer);
/* Flushes, checks and renames; on failure removes the temporary file. Releases the writer either way. */
bool tl_writer_commit(struct tl_writer *writer, tl_error *error);
/* Removes the temporary file. Safe on a zeroed or already released writer. */
void tl_writer_abandon(struct tl_writer *writer);

/* Makes a folder and its parents; fine when it exists. */
bool tl_folder_make(const char *path, tl_error *error);

/* `relative` seen from the folder that holds `base_file`; absolute paths are returned as they are. New
 * string. */
char *tl_path_relative_to(const char *base_file, const char *relative);

/* Whether a file that another file names lies in that one's folder or below it, symbolic links followed.
 * `base` is the naming file, or one above it. False, with a message that names both, unless
 * tl_path_allow_outside was called. A file that does not exist is judged by its name. */
bool tl_path_is_inside(const char *base, const char *path, tl_error *error);
/* Lifts that restriction; before threads start. */
void tl_path_allow_outside(void);

/* True when `path` ends in `.extension` (no dot given), ignoring case. */
bool tl_path_has_extension(const char *path, const char *extension);

#endif
