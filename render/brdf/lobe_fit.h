/* The gloss towards one viewer as a few cosine lobes, which is what prefiltered light can be asked with
 * [DESIGN 4; TECHNIQUES D7, "several lobes for a BRDF"]:
 *
 *     f_r(l, v) cos a  ~  sum over k of weight_k K_{s_k}(direction_k, l)
 *
 * Facets whose slopes spread as a Gaussian of covariance S spread the light they reflect by J S J^T, J being
 * the derivative of the mirror direction by the slope. Lobes are as narrow as its narrow axis and lie along
 * its broad one, each where a facet of that slope sends the light, so that they follow the cone of a strongly
 * anisotropic gloss; where there are too few of them to touch each other they are widened. Their weights are
 * the gloss over the density of the slopes there, and add up to the gloss's albedo towards the viewer by
 * Gauss-Hermite quadrature: light that is the same from everywhere is kept. What of a lobe lies below the
 * horizon is made up for by what lies above.
 *
 * Errors: tests/render/brdf/test_lobe_fit.c prints them. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_LOBE_FIT_H
#define TOILE_RENDER_BRDF_LOBE_FIT_H

#include "render/brdf/brdf.h"

#define TL_LOBE_FIT_MAX 7

struct tl_fitted_lobe {
    vec3s direction; /* unit, as the frame */
    float exponent;
    vec3s weight; /* by channel */
};

/* Up to `most` lobes, 1 to TL_LOBE_FIT_MAX; returns how many. Fewer serve where the gloss is round. */
int tl_lobe_fit_make(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, int most,
                     struct tl_fitted_lobe lobes[TL_LOBE_FIT_MAX]);

/* The least and the greatest exponent of any lobe, towards all viewers and however many there are. */
void tl_lobe_fit_exponents(const struct tl_brdf *brdf, float *least, float *greatest);

/* Gloss under a source of light that is a disc of this radius (rad) about `l`: tl_brdf_gloss, its facets
 * spread by as much as the disc spreads its light. */
vec3s tl_brdf_gloss_under_disc(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l,
                               vec3s v, float radius);

#endif
