/* The terms of surface_terms.glsl in C, from the same text. Pure; threads: any. */
#ifndef TOILE_RENDER_SURFACES_SURFACE_TERMS_H
#define TOILE_RENDER_SURFACES_SURFACE_TERMS_H

#include "render/detail/bump_statistics.h"

typedef struct SurfaceColours SurfaceColours;
typedef struct SurfaceShape SurfaceShape;
typedef struct SurfaceTexels SurfaceTexels;

#include "render/gpu/terms_begin.h"

#include "render/surfaces/surface_terms.glsl"

#include "render/gpu/terms_end.h"

#endif
