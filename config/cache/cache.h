/* A cache of files in the user's cache folder: bytes under a key of 128 bits, such as a drape under a hash of
 * all that decides it. The least recently used files are removed when there are more bytes than the limit.
 *
 * Several processes may use a folder at once: a file is written under another name and renamed, and a reader
 * checks its length and checksum; a damaged file is removed, with a line in the log. The cache never makes a
 * command fail: what cannot be read is a miss, what cannot be written is not kept.
 *
 * Lifetime: strings and data that are returned are the caller's, to free. Threads: tl_cache_use before others
 * begin; the rest on any thread. */
#ifndef TOILE_CONFIG_CACHE_CACHE_H
#define TOILE_CONFIG_CACHE_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#define TL_CACHE_LIMIT_BYTES ((uint64_t)1000000000)

/* $XDG_CACHE_HOME/toile/drapes, or ~/.cache/toile/drapes; NULL when the environment names neither. */
char *tl_cache_folder(void);

/* The folder to use from now on, and the bytes to keep in it; NULL: no cache, which is the state at first. */
void tl_cache_use(const char *folder, uint64_t limit_bytes);
bool tl_cache_is_used(void);

struct tl_cache_key {
    uint64_t words[2];
};
/* An empty key, and a key extended by bytes. */
struct tl_cache_key tl_cache_key_begin(void);
void tl_cache_key_add(struct tl_cache_key *key, const void *bytes, size_t size);

/* False when there is no such file, or it was damaged. */
bool tl_cache_load(const struct tl_cache_key *key, void **data, size_t *size);
/* The same into `size` bytes of the caller's; false as well where it has another size. */
bool tl_cache_read(const struct tl_cache_key *key, void *data, size_t size);
void tl_cache_store(const struct tl_cache_key *key, const void *data, size_t size);

/* The entries of a folder, the most recently used first. */
struct tl_cache_entry {
    char name[64];
    uint64_t bytes;
    struct timespec used;
};
struct tl_cache_entry *tl_cache_list(const char *folder, size_t *count);

/* Removes the cache's files from a folder; returns how many. */
size_t tl_cache_clear(const char *folder);

#endif
