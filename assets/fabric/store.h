/* A folder or a zip archive, read by the names of its files relative to it.
 *
 * A name that leads out of the store (absolute, a drive, "..", a backslash) is refused, in an archive's own
 * list too. An archive's sizes are checked against its length and against TL_LIMIT_STORE_BYTES before memory
 * is allocated; its checksums are checked as it is read.
 *
 * Errors: false with one line (TL_INPUT). Lifetime: tl_store_close frees the store and its names. Threads: a
 * store is used by one thread at a time. */
#ifndef TOILE_ASSETS_FABRIC_STORE_H
#define TOILE_ASSETS_FABRIC_STORE_H

#include "config/base/error.h"

#include <stddef.h>
#include <stdint.h>

#define TL_LIMIT_STORE_FILES 4096
#define TL_LIMIT_STORE_BYTES ((uint64_t)1 << 30) /* of one file, decompressed */

typedef struct tl_store {
    char *path;   /* of the folder or the archive */
    void *zip;    /* libzip's archive; NULL for a folder */
    char **names; /* of its files, sorted; of a folder those that stand in it directly */
    size_t count;
} tl_store;

/* Opens a folder, or an archive: a file that ends in .zip or .u3ma. */
bool tl_store_open(const char *path, tl_store *out, tl_error *error);
void tl_store_close(tl_store *store); /* frees and zeroes */

/* Reads a whole file of at most `limit` bytes; *data is followed by a NUL that *size does not count;
 * free(*data). */
bool tl_store_read(const tl_store *store, const char *name, size_t limit, char **data, size_t *size,
                   tl_error *error);

/* Whether a name can be read. Only a refused one, which leads out of the store, sets an error. */
enum tl_store_found { TL_STORE_FOUND, TL_STORE_MISSING, TL_STORE_REFUSED };
enum tl_store_found tl_store_find(const tl_store *store, const char *name, tl_error *error);

/* "path/name", for messages: a new string. */
char *tl_store_place(const tl_store *store, const char *name);

/* Whether the path ends as an archive's does. */
bool tl_store_is_archive(const char *path);

#endif
