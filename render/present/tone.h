/* The C face of tone.glsl: from light to a screen's values, one text for both languages. Pure. */
#ifndef TOILE_RENDER_PRESENT_TONE_H
#define TOILE_RENDER_PRESENT_TONE_H

#include "config/base/simd.h"

/* GLSL's names, while the file is read. */
#define TERM  TL_INLINE
#define clamp tone_clamp
#define pow   powf
TL_INLINE float tone_clamp(float x, float low, float high)
{
    return tl_maxf(tl_minf(x, high), low);
}
#include "render/present/tone.glsl"
#undef TERM
#undef clamp
#undef pow

#endif
