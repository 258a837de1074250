/* The garments that were opened last, the latest first: absolute paths, in a YAML file of the state's folder
 * (app/view/memory/state.h).
 *
 * A missing file means none. Errors: TL_USAGE or TL_INPUT when the file is malformed, and nothing of it is
 * used; TL_OUTPUT when it cannot be written. Threads: any, one at a time for a file. */
#ifndef TOILE_APP_VIEW_MEMORY_RECENT_H
#define TOILE_APP_VIEW_MEMORY_RECENT_H

#include "config/base/error.h"
#include "config/options.h"

#include <stddef.h>

#define TL_RECENT_MAX 10
struct tl_recent {                       /* table "recent" */
    const char *garments[TL_RECENT_MAX]; /* interned; "" or NULL: no more */
};

/* Puts a file in front, once; the oldest of more than TL_RECENT_MAX is forgotten. A path that is too long is
 * left out. */
void tl_recent_add(struct tl_recent *recent, const char *path);
size_t tl_recent_count(const struct tl_recent *recent);

bool tl_recent_load(const char *file, struct tl_recent *out, tl_error *error);
/* Writes the file completely or not at all; creates its folder. */
bool tl_recent_save(const char *file, const struct tl_recent *recent, tl_error *error);

#endif
