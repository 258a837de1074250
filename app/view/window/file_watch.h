/* Files that may be edited while they are in use: tells when one has changed on disk. Threads: one. */
#ifndef TOILE_APP_VIEW_WINDOW_FILE_WATCH_H
#define TOILE_APP_VIEW_WINDOW_FILE_WATCH_H

#include "config/options.h"

#include <stdint.h>

#define TL_WATCHED_MAX 8

struct tl_file_watch {
    struct tl_watched_file {
        char path[TL_STRING_SIZE];
        uint64_t stamp; /* of its time and size; 0: it is not there */
    } files[TL_WATCHED_MAX];
    size_t next; /* to be replaced */
};

/* True once after each change of the file. The first call for a path learns what it is like. */
bool tl_file_has_changed(struct tl_file_watch *watch, const char *path);

#endif
