/* A fit of the gloss towards one viewer by a few cosine lobes, for which prefiltered light can be looked up
 * [after Knuth et al. 2014, 6]:
 *
 *     f_r(l, v) cos a  ~  sum over k of weight_k K_{s_k}(direction_k, l)
 *
 * Facets whose slopes are Gaussian with covariance S spread the light they reflect with covariance J S J^T,
 * where J is the derivative of the mirror direction by the slope. The lobes lie along the broad axis of that
 * covariance, each in the direction in which a facet of its slope reflects, so that they follow the cone of a
 * strongly anisotropic gloss; slopes that send light below the horizon get none. Each is as narrow as light
 * spreads across the axis about its own facet: towards a grazing viewer that changes several times along the
 * set. Where there are too few lobes to overlap they are widened. The weight of a lobe is the gloss divided
 * by the pdf of the slopes there. All weights are then scaled so that their sum is the albedo of the gloss
 * towards the viewer, computed by Gauss-Legendre quadrature; this keeps light that is the same from
 * everywhere. The part of a lobe above the horizon is scaled up for the part that lies below it.
 *
 * GGX facets, whose slopes have long tails, have lobes from a table of fits (ggx_lobes.h): 1, 3, 5 or 7.
 *
 * tests/render/brdf/test_lobe_fit.c prints the errors. Pure; threads: any. */
#ifndef TOILE_RENDER_BRDF_LOBE_FIT_H
#define TOILE_RENDER_BRDF_LOBE_FIT_H

#include "render/brdf/brdf.h"

#define TL_LOBE_FIT_MAX 11 /* lobes */

struct tl_fitted_lobe {
    vec3s direction; /* unit, in the space of the frame's vectors */
    float exponent;
    vec3s weight; /* by channel */
};

/* Fits at most `maximum` lobes (1 to TL_LOBE_FIT_MAX) and returns their number: as many as it takes, and
 * `minimum` of facets with Gaussian slopes. 0 when the viewer is below the surface. */
int tl_lobe_fit_make(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s v, int minimum,
                     int maximum, struct tl_fitted_lobe lobes[TL_LOBE_FIT_MAX]);

/* The fits of each gloss of a sum, one after the other, without lobes that reflect nothing: those of
 * tl_lobe_fit_make (test_threads: within 1e-3), in one evaluation where all are Ward's. Returns their number.
 */
#define TL_LOBE_FIT_SUM_MAX ((1 + TL_THREADS_MAX) * TL_LOBE_FIT_MAX)
int tl_lobe_fit_sum(const struct tl_brdf_sum *sum, const struct tl_brdf_frame *frame, vec3s v, int max_count,
                    struct tl_fitted_lobe lobes[TL_LOBE_FIT_SUM_MAX]);

/* The smallest and the largest exponent of any lobe, over all viewers and numbers of lobes. */
void tl_lobe_fit_exponents(const struct tl_brdf *brdf, float *min, float *max);

/* Gloss under a light that is a disc of angular radius `radius` (rad) about `l`: tl_brdf_gloss with the
 * facets widened by the variance of the disc. */
vec3s tl_brdf_gloss_under_disc(const struct tl_brdf *brdf, const struct tl_brdf_frame *frame, vec3s l,
                               vec3s v, float radius);

#endif
