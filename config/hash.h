/* FNV-1a, 64 bits [Fowler, Noll, Vo]: tells apart what is not the same to the bit. Threads: pure. */
#ifndef TOILE_CONFIG_HASH_H
#define TOILE_CONFIG_HASH_H

#include <stddef.h>
#include <stdint.h>

#define TL_HASH_START 14695981039346656037u

/* Going on from `hash`. */
uint64_t tl_hash(uint64_t hash, const void *bytes, size_t size);

#endif
