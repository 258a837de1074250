/* The C face of detail_terms.glsl: detail's scalar terms, one text for both languages. Pure. */
#ifndef TOILE_RENDER_DETAIL_TERMS_H
#define TOILE_RENDER_DETAIL_TERMS_H

#include "render/gpu/glsl.h"

/* GLSL's names, while the file is read. */
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
