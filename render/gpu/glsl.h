/* Functions of GLSL for texts that C includes as well (light/terms.glsl, detail/detail_terms.glsl). A header
 * that includes such a text defines the names that it uses as these for as long as it is read. Comparisons
 * rather than fmaxf: compilers turn loops over them into vector code. Pure. */
#ifndef TOILE_RENDER_GPU_GLSL_H
#define TOILE_RENDER_GPU_GLSL_H

#include <math.h>

static inline float term_max(float a, float b)
{
    return a > b ? a : b;
}
static inline float term_min(float a, float b)
{
    return a < b ? a : b;
}
static inline float term_clamp(float x, float low, float high)
{
    return x < low ? low : (x > high ? high : x);
}

#endif
