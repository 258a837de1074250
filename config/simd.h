/* Wide arithmetic without intrinsics: GCC's vector types and one clone of a function for each kind of
 * machine.
 *
 * Results are the same on every machine: lanes are fixed by the type, not by the machine, and nothing is
 * contracted or reordered. Thread-safe, pure. */
#ifndef TOILE_CONFIG_SIMD_H
#define TOILE_CONFIG_SIMD_H

#include <stdint.h>

/* 16 floats, as wide as a machine can have them; narrower ones take several instructions. */
#define TL_LANES 16
typedef float tl_lanes __attribute__((vector_size(TL_LANES * sizeof(float))));
typedef int32_t tl_lanes_int __attribute__((vector_size(TL_LANES * sizeof(float))));

/* Lanes pass by value only between static inline functions, so that how the ABI passes them is no concern. */
#pragma GCC diagnostic ignored "-Wpsabi"

/* Before a hot function's definition: it is compiled for AVX-512, for AVX2 and for any x86-64, and the best
 * is chosen as the program starts. Static inline functions that it calls go with it. Sanitizers run before
 * such a choice can be made, so with them there is one version. */
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define TL_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define TL_CLONES
#endif

/* For what such a function calls: inlined whatever its size, and so compiled for the same machine. */
#define TL_LANES_INLINE static inline __attribute__((always_inline))

#endif
