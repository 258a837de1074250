/* The terms of bumps_terms.glsl in C, from the same text. Pure; threads: any. */
#ifndef TOILE_RENDER_DETAIL_BUMP_STATISTICS_H
#define TOILE_RENDER_DETAIL_BUMP_STATISTICS_H

#include "render/detail/detail_terms.h"
#include "render/detail/options.h"

typedef struct Bumps Bumps;

#include "render/gpu/terms_begin.h"

#include "render/detail/bumps_terms.glsl"

#include "render/gpu/terms_end.h"

#endif
