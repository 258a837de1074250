/* Tables factored numerically out of samples of reflectance, by homomorphic factorisation [McCool et al.
 * 2001]:
 *
 *     f_r(l, v) = p(l) p(v) q(h) r(h.l, n.h)
 *
 * The logarithm of the product is a sum, so the logarithms of all texels follow from one sparse least-squares
 * problem. p and q are over directions, on paraboloid maps (tables.h). r is added to the paper's factors: it
 * has what Fresnel's term does, and lobes that get narrower or wider towards grazing light. Whatever the
 * samples, the product is reciprocal and positive. Ward's published model has this form, Torrance and
 * Sparrow's and the cosine lobe nearly; models that are not reciprocal have not.
 *
 * The first guess is the solution by logarithms on tables of a quarter of the size, but of 16 texels
 * at least. From there the roots of
 * f_r cos a are brought near those of the samples, whose squared errors lie between absolute and relative
 * ones of f_r cos a, on tables of a quarter, half and the whole size, interpolated as they are drawn: by
 * Levenberg and Marquardt's method, each step by conjugate gradients. Where no sample lies, second
 * differences of the logarithms are smallest, so gaps are bridged smoothly.
 *
 * Pure; the result is the same at any number of threads. */
#ifndef TOILE_RENDER_BRDF_TABLES_FACTOR_H
#define TOILE_RENDER_BRDF_TABLES_FACTOR_H

#include "assets/fabric/samples.h"
#include "render/brdf/tables/tables.h"

#define TL_FACTOR_SIZE_MIN 16
#define TL_FACTOR_SIZE_MAX 128

/* The size of tables that so many samples determine: 16, 32, 64 or 128, with four samples or more a texel
 * where there are that many. */
int tl_factor_size(size_t samples);

/* Makes the four tables, in float: q has size x size texels, p and r have half as many along each side;
 * `size` is at least TL_FACTOR_SIZE_MIN. The samples must have passed tl_reflectance_samples_load or be as
 * those are. *bridged, unless NULL: the share of directions that no sample reaches. The caller releases the
 * tables. */
struct tl_brdf_tables tl_brdf_tables_factor(const struct tl_reflectance_samples *samples, int size,
                                            double *bridged);

/* Samples of a model's gloss: pairs of directions that fill all half vectors and differences evenly, from a
 * fixed sequence. The caller releases them. */
struct tl_reflectance_samples tl_brdf_model_samples(const struct tl_brdf *brdf, size_t count);

/* The four tables of a model's gloss, factored out of 12 size^2 samples; `size` is limited to
 * TL_FACTOR_SIZE_MIN to TL_FACTOR_SIZE_MAX. */
struct tl_brdf_tables tl_brdf_tables_refactor(const struct tl_brdf *brdf, int size);

#endif
