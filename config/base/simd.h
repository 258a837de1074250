/* Vector arithmetic without intrinsics: a loop over TL_LANES elements whose body has no branch, in a function
 * that is compiled once for each instruction set. GCC then vectorises the loop to the machine's full width.
 *
 * Results are the same on every machine: lanes are summed in a fixed order, and nothing is contracted or
 * reordered. (GCC's vector types are lowered to narrow ones before the clones are made, so they would gain
 * nothing here.) */
#ifndef TOILE_CONFIG_BASE_SIMD_H
#define TOILE_CONFIG_BASE_SIMD_H

#include <math.h>
#include <stdint.h>

#define TL_LANES 16

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TL_SANITIZED /* as GCC names it */
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer) || __has_feature(address_sanitizer)
#define TL_SANITIZED /* as Clang does */
#endif
#endif

/* Before a hot function's definition: it is compiled for AVX-512, for AVX2 and for any x86-64, and the best
 * is chosen when the program starts. Functions that it calls must be TL_INLINE to be cloned with it. The
 * choice is made before a sanitizer has started, and would crash in its instrumentation: with sanitizers
 * there is one version. */
#if defined(__x86_64__) && !defined(TL_SANITIZED)
#define TL_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define TL_CLONES
#endif
#define TL_INLINE static inline __attribute__((always_inline))

/* The rules of fminf and fmaxf for NaN and signed zero prevent vectorisation. */
TL_INLINE float tl_minf(float a, float b)
{
    return a < b ? a : b;
}
TL_INLINE float tl_maxf(float a, float b)
{
    return a > b ? a : b;
}

/* The sum of TL_LANES numbers, in pairs. */
TL_INLINE float tl_sum_lanes(const float lanes[TL_LANES])
{
    float sums[TL_LANES / 2];
    for (int i = 0; i < TL_LANES / 2; i++)
        sums[i] = lanes[i] + lanes[i + TL_LANES / 2];
    for (int width = TL_LANES / 4; width > 0; width /= 2)
        for (int i = 0; i < width; i++)
            sums[i] += sums[i + width];
    return sums[0];
}

union tl_float_bits {
    float value;
    int32_t bits;
};

/* log2 of a positive normal number within 1e-6: its exponent, and a polynomial that interpolates log2 at
 * Chebyshev nodes between sqrt(1/2) and sqrt(2). */
TL_INLINE float tl_log2(float a)
{
    const int32_t half_root = 0x3f3504f3; /* sqrt(1/2) */
    int32_t offset = ((union tl_float_bits){.value = a}).bits - half_root;
    float exponent = (float)(offset >> 23);
    float u = ((union tl_float_bits){.bits = (offset & 0x007fffff) + half_root}).value - 1.0f;
    float series =
        0.480613125f + u * (-0.359524455f + u * (0.296119557f + u * (-0.267963871f + u * 0.168186591f)));
    return exponent + u * (1.44269652f + u * (-0.721360179f + u * series));
}

/* 2^a within 4e-7 relative; a is clamped to -80 .. 127: products of smaller powers would be
 * denormal, which costs a hundred times as much. The polynomial interpolates 2^f at Chebyshev nodes. */
TL_INLINE float tl_exp2(float a)
{
    a = tl_maxf(tl_minf(a, 127.0f), -80.0f);
    int32_t whole = (int32_t)(a + 127.0f) - 127; /* floor */
    float f = a - (float)whole;
    float series =
        0.693147568f + f * (0.240207194f + f * (0.0556570544f + f * (0.0091993876f + f * 0.00178836874f)));
    union tl_float_bits power = {.value = 1.0f + f * series};
    power.bits += whole * (1 << 23);
    return power.value;
}

/* a^b for a >= 0 and b > 0. Below 1e-30 a counts as 1e-30. */
TL_INLINE float tl_power(float a, float b)
{
    return tl_exp2(b * tl_log2(tl_maxf(a, 1e-30f)));
}

#endif
