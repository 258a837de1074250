/* Tables factored numerically out of samples of reflectance, by homomorphic factorisation [McCool, Ang and Ahmad
 * 2001, "Homomorphic factorization of BRDFs for high-performance rendering"]:
 *
 *     f_r(l, v) = p(l) p(v) q(h) r(h.l)
 *
 * The logarithm of the product is a sum, so the logarithms of all texels follow from one sparse least-squares
 * problem. r is added to the three factors of the paper; it holds what Fresnel's term does. p and q are over
 * directions, on paraboloid maps (tables.h); whatever the samples, the product is reciprocal and positive.
 * Ward's published model has this form, and Torrance and Sparrow's nearly; r.l of Phong's model has not.
 *
 * The problem is solved on tables of a quarter, half and the whole of their size, each time by a few
 * linearisations (Gauss and Newton) about the interpolation that is drawn, of texels and not of their
 * logarithms, each by conjugate gradients. A sample counts by its size next to the mean: the error of the dark
 * is not seen. Where no sample lies, second differences of the logarithms are smallest, so gaps are bridged
 * smoothly.
 *
 * Pure; the result is the same at any number of threads. */
#ifndef TOILE_RENDER_BRDF_TABLES_FACTOR_H
#define TOILE_RENDER_BRDF_TABLES_FACTOR_H

#include "assets/measured/samples.h"
#include "render/brdf/tables/tables.h"

#define TL_FACTOR_SIZE_MIN 16

struct tl_factor_report {
    double rel_rmse; /* of f_r cos a over the samples, all channels together */
    double bridged;  /* share of the directions' map, within the hemisphere, that no sample reaches */
};

/* Makes the four tables, in float: q has size x size texels, p half as many along each side, r size x 1;
 * `size` at least TL_FACTOR_SIZE_MIN. The samples must have passed tl_reflectance_samples_load or be as those
 * are. `report` may be NULL. The caller releases the tables. */
struct tl_brdf_tables tl_brdf_tables_factor(const struct tl_reflectance_samples *samples, int size,
                                            struct tl_factor_report *report);

/* Samples of a model's gloss: pairs of directions that fill all half vectors and differences evenly, from a
 * fixed sequence. The caller releases them. */
struct tl_reflectance_samples tl_brdf_model_samples(const struct tl_brdf *brdf, size_t count);

#endif
