/* The terms of facets_terms.glsl in C, from the same text. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_FACETS_H
#define TOILE_RENDER_BRDF_FACETS_H

#include "render/gpu/vectors.h"

typedef struct FacetAxes FacetAxes;
typedef struct FacetReflected FacetReflected;
typedef struct FacetWidening FacetWidening;
typedef struct LobeSet LobeSet;
typedef struct SlopeAxes SlopeAxes;
typedef struct SlopeLobe SlopeLobe;
typedef struct SlopeQuadrature SlopeQuadrature;
typedef struct WardFacets WardFacets;
typedef struct WardLobe WardLobe;
typedef struct WardSlope WardSlope;
typedef struct WardValues WardValues;

#include "render/gpu/terms_begin.h"

#include "render/brdf/facets_terms.glsl"

#include "render/gpu/terms_end.h"

#endif
