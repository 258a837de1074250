/* Pseudo-random numbers, the same on every machine: splitmix64 [Steele et al. 2014]. Each work item
 * starts its own sequence from a key, so that results depend neither on threads nor on their order. Pure. */
#ifndef TOILE_RENDER_REFERENCE_RANDOM_H
#define TOILE_RENDER_REFERENCE_RANDOM_H

#include <stdint.h>

struct tl_random {
    uint64_t state;
};

/* The next 64 bits. */
static inline uint64_t tl_random_bits(struct tl_random *random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Starts the sequence of a key (a, b). */
static inline struct tl_random tl_random_begin(uint64_t a, uint64_t b)
{
    struct tl_random random = {a};
    random.state = tl_random_bits(&random) ^ b;
    random.state = tl_random_bits(&random);
    return random;
}

/* The next number in [0, 1), in steps of 2^-53. */
static inline double tl_random_unit(struct tl_random *random)
{
    return (double)(tl_random_bits(random) >> 11) * 0x1p-53;
}

#endif
