/* Cosine lobes K_s: the terms of lobes_terms.glsl in C, from the same text. Pure; threads: any. */
#ifndef TOILE_RENDER_ENV_EXPONENT_H
#define TOILE_RENDER_ENV_EXPONENT_H

#include "render/gpu/vectors.h"

#include "render/gpu/terms_begin.h"

#include "render/env/lobes_terms.glsl"

#include "render/gpu/terms_end.h"

/* lobe_exponent and lobe_cosine for callers without lanes; 0 below the horizon. */
float tl_lobe_exponent(float glossiness);
float tl_lobe_cosine(float exponent, float cosine);

#endif
