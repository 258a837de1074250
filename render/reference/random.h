/* Numbers that look random and are the same everywhere: splitmix64 [Steele, Lea and Flood 2014], begun anew
 * from a key for every piece of work, so that neither threads nor their order matter. Pure. */
#ifndef TOILE_RENDER_REFERENCE_RANDOM_H
#define TOILE_RENDER_REFERENCE_RANDOM_H

#include <stdint.h>

struct tl_random {
    uint64_t state;
};

static inline uint64_t tl_random_bits(struct tl_random *random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static inline struct tl_random tl_random_begin(uint64_t a, uint64_t b)
{
    struct tl_random random = {a};
    random.state = tl_random_bits(&random) ^ b;
    random.state = tl_random_bits(&random);
    return random;
}

/* [0, 1), in steps of 2^-53. */
static inline double tl_random_unit(struct tl_random *random)
{
    return (double)(tl_random_bits(random) >> 11) * 0x1p-53;
}

#endif
