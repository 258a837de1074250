/* Fuzz: the sheen of short fibres that stand on a cloth, over everything else of its material:
 *
 *     Lo = colour Lfuzz + (1 - R max colour) Lbase        [Zeltner et al. 2022; MaterialX]
 *
 * fuzz_terms.glsl has its lobe, which lamps, suns and the reference evaluate. For light from an environment
 * the lobe is replaced by its mean over the azimuth of the light, as a signed sum of cosine powers about the
 * smooth normal, each of which is a prefiltered map that exists:
 *
 *     Lfuzz = R sum over k of w_k E(n, s_k),  s = 1, 2, 4, 8,  sum of w = 1
 *
 * The w_k minimise the integral over the cosine of the squared difference. Light that is the same from
 * everywhere is exact. The fibres stand over weave and seams on the smooth normal, those of a pile lean with
 * its bumps (fuzz_axis): n is their axis. The lobe is not
 * reciprocal. tests/render/brdf/test_fuzz.c has the errors. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_FUZZ_H
#define TOILE_RENDER_BRDF_FUZZ_H

#include "assets/base/material.h"
#include "config/base/simd.h"
#include "render/gpu/vectors.h"

#include "render/gpu/terms_begin.h"

#include "render/brdf/fuzz_terms.glsl"

#include "render/gpu/terms_end.h"

/* Indices of the exponents in env/lobes.h. */
#define TL_FUZZ_INDEX(k)  (3 * (k))
#define TL_FUZZ_EXPONENTS (1u | 1u << 3 | 1u << 6 | 1u << 9)

#endif
