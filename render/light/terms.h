/* The C face of terms.glsl: the light's scalar terms, one text for both languages. Pure. */
#ifndef TOILE_RENDER_LIGHT_TERMS_H
#define TOILE_RENDER_LIGHT_TERMS_H

#include "render/gpu/glsl.h"

/* GLSL's names, while the file is read. */
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
