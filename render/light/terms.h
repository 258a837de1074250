/* The C face of terms.glsl: the light's scalar terms, one text for both languages. Pure. */
#ifndef TOILE_RENDER_LIGHT_TERMS_H
#define TOILE_RENDER_LIGHT_TERMS_H

#include <math.h>

/* GLSL's names, while the file is read. Comparisons rather than fmaxf, so that loops over them can be wide.
 */
static inline float term_max(float a, float b)
{
    return a > b ? a : b;
}
static inline float term_clamp(float x, float low, float high)
{
    return x < low ? low : (x > high ? high : x);
}
#define TERM  static inline
#define max   term_max
#define clamp term_clamp
#define pow   powf
#define sin   sinf
#include "render/light/terms.glsl"
#undef TERM
#undef max
#undef clamp
#undef pow
#undef sin

#endif
