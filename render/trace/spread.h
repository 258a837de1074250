/* The terms of spread_terms.glsl in C, from the same text. Pure; threads: any. */
#ifndef TOILE_RENDER_TRACE_SPREAD_H
#define TOILE_RENDER_TRACE_SPREAD_H

#include "render/gpu/vectors.h"

#include "render/gpu/terms_begin.h"

#include "render/trace/spread_terms.glsl"

#include "render/gpu/terms_end.h"

#endif
