/* FNV-1a, 64 bits [Fowler, Noll, Vo]: detects change; it does not protect against forgery. Threads: pure. */
#ifndef TOILE_CONFIG_BASE_HASH_H
#define TOILE_CONFIG_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define TL_HASH_START 14695981039346656037u

/* The hash of what `hash` covers, followed by `bytes`. The first call passes TL_HASH_START. */
static inline uint64_t tl_hash(uint64_t hash, const void *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ ((const uint8_t *)bytes)[i]) * 1099511628211u;
    return hash;
}

/* The same of 64 bits at a time, for megabytes: another hash, eight times as fast. */
static inline uint64_t tl_hash_words(uint64_t hash, const void *bytes, size_t size)
{
    const size_t words = size / sizeof(uint64_t);
    for (size_t i = 0; i < words; i++) {
        uint64_t word;
        memcpy(&word, (const uint8_t *)bytes + i * sizeof word, sizeof word);
        hash = (hash ^ word) * 1099511628211u;
        hash ^= hash >> 32; /* a product carries upwards only */
    }
    return tl_hash(hash, (const uint8_t *)bytes + words * sizeof(uint64_t), size % sizeof(uint64_t));
}

#endif
