/* Detects that a file has changed on disk, by its modification time and size. Nothing fails: a missing file
 * is one that has not changed. Lifetime: a plain struct, zero at first. Threads: one. */
#ifndef TOILE_APP_VIEW_WINDOW_FILE_WATCH_H
#define TOILE_APP_VIEW_WINDOW_FILE_WATCH_H

#include "config/options.h"

#include <stdint.h>

#define TL_WATCHED_MAX 8

struct tl_file_watch {
    struct tl_watched_file {
        char path[TL_STRING_SIZE];
        uint64_t stamp; /* hash of its time, size and inode; 0: it does not exist */
    } files[TL_WATCHED_MAX];
    size_t next; /* the entry to replace next */
};

/* True once after each change of the file. The first call for a path is false. */
bool tl_file_has_changed(struct tl_file_watch *watch, const char *path);

#endif
