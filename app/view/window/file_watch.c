#include "app/view/window/file_watch.h"

#include "config/base/hash.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static uint64_t stamp_of(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return 0;
    const uint64_t parts[] = {(uint64_t)status.st_mtim.tv_sec, (uint64_t)status.st_mtim.tv_nsec,
                              (uint64_t)status.st_size, (uint64_t)status.st_ino};
    uint64_t stamp = tl_hash(TL_HASH_START, parts, sizeof parts);
    return stamp ? stamp : 1;
}

bool tl_file_has_changed(struct tl_file_watch *watch, const char *path)
{
    uint64_t stamp = stamp_of(path);
    for (size_t i = 0; i < TL_WATCHED_MAX; i++) {
        struct tl_watched_file *file = &watch->files[i];
        if (strcmp(file->path, path) != 0)
            continue;
        bool changed = stamp != file->stamp && stamp != 0; /* it is missing while its writer replaces it */
        if (stamp != 0)
            file->stamp = stamp;
        return changed;
    }
    struct tl_watched_file *file = &watch->files[watch->next++ % TL_WATCHED_MAX];
    snprintf(file->path, sizeof file->path, "%s", path);
    file->stamp = stamp;
    return false;
}
