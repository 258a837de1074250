/* The scalar terms of detail_terms.glsl in C, from the same text. Pure; threads: any. */
#ifndef TOILE_RENDER_DETAIL_TERMS_H
#define TOILE_RENDER_DETAIL_TERMS_H

#include "render/gpu/vectors.h"

#include "render/gpu/terms_begin.h"

#include "render/detail/detail_terms.glsl"

#include "render/gpu/terms_end.h"

#endif
