/* Functions and vectors of GLSL for texts that C includes as well (terms_begin.h). Vectors are cglm's, whose
 * components have the same names. Comparisons rather than fmaxf: compilers turn loops over them into vector
 * code. Pure. */
#ifndef TOILE_RENDER_GPU_VECTORS_H
#define TOILE_RENDER_GPU_VECTORS_H

#include "config/base/simd.h"

#include <cglm/struct.h>

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

typedef uint32_t term_uint;
typedef vec2s term_vec2;
typedef vec3s term_vec3;
typedef vec4s term_vec4;

TL_INLINE float term_max(float a, float b)
{
    return a > b ? a : b;
}
TL_INLINE float term_min(float a, float b)
{
    return a < b ? a : b;
}
TL_INLINE float term_clamp(float x, float low, float high)
{
    return x < low ? low : (x > high ? high : x);
}
TL_INLINE float term_inversesqrt(float x)
{
    return 1 / sqrtf(x);
}
TL_INLINE vec3s vec3_add(vec3s a, vec3s b)
{
    return glms_vec3_add(a, b);
}
TL_INLINE vec3s vec3_subtract(vec3s a, vec3s b)
{
    return glms_vec3_sub(a, b);
}
TL_INLINE vec3s vec3_multiply(vec3s a, vec3s b)
{
    return glms_vec3_mul(a, b);
}
TL_INLINE vec3s vec3_scale(vec3s a, float factor)
{
    return glms_vec3_scale(a, factor);
}

#include "render/gpu/terms_begin.h"

#include "render/gpu/vectors.glsl"

#include "render/gpu/terms_end.h"

#endif
