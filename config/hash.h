/* FNV-1a, 64 bits [Fowler, Noll, Vo]: detects change; it does not protect against forgery. Threads: pure. */
#ifndef TOILE_CONFIG_HASH_H
#define TOILE_CONFIG_HASH_H

#include <stddef.h>
#include <stdint.h>

#define TL_HASH_START 14695981039346656037u

/* The hash of what `hash` covers, followed by `bytes`. The first call passes TL_HASH_START. */
static inline uint64_t tl_hash(uint64_t hash, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ ((const uint8_t *)bytes)[i]) * 1099511628211u;
    return hash;
}

#endif
