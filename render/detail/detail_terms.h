/* The scalar terms of detail_terms.glsl in C, from the same text. Pure; threads: any. */
#ifndef TOILE_RENDER_DETAIL_TERMS_H
#define TOILE_RENDER_DETAIL_TERMS_H

#include "render/gpu/glsl.h"

/* Names of GLSL, while the file is read. */
#define TERM  static inline
#define max   term_max
#define clamp term_clamp
#define asin  asinf
#define floor floorf
#define sqrt  sqrtf
#define sin   sinf
#include "render/detail/detail_terms.glsl"
#undef TERM
#undef max
#undef clamp
#undef asin
#undef floor
#undef sqrt
#undef sin

#endif
