/* How far what a prefilter shows of one lit texel is from the cosine lobe: the ruler of the paper's figures 4
 * and 5 [002, section 5], with the metric written down. Pure; results do not depend on the number of threads.
 *
 * One texel of a cube sends light of power 1. What a prefilter shows of it in direction d, E(d, s), is its
 * lobe; what it should be is K_s averaged over the texel:
 *
 *     error       = integral |E - K| dd / integral K dd             over the whole sphere
 *     energy      = integral E dd / integral K dd
 *     same volume = integral |E / energy - K| dd / integral K dd
 *
 * The paper compares lobes of the same volume, seen from one fixed pixel, and does not say how it samples
 * them. The first figure judges the light that a pixel gets; the last one the shape alone, which is as near
 * to the paper as its text allows. */
#ifndef TOILE_RENDER_PEM_LOBE_ERROR_H
#define TOILE_RENDER_PEM_LOBE_ERROR_H

#include "render/env/cube.h"

struct tl_lobe_error {
    double error, energy, same_volume;
};

/* A texel of a cube, with directions and weights that stand for its area. */
#define TL_LOBE_SOURCE_POINTS 9
struct tl_lobe_source {
    int texel;      /* (face * size + y) * size + x */
    float radiance; /* that gives power 1 */
    vec3s points[TL_LOBE_SOURCE_POINTS];
    double weights[TL_LOBE_SOURCE_POINTS]; /* sum 1 */
};
/* The texel that the direction lies in. */
struct tl_lobe_source tl_lobe_source(int cube_size, vec3s direction);

/* What the prefilter shows in direction d, one channel. */
typedef double tl_lobe_response(const void *prefilter, vec3s direction);
struct tl_lobe_error tl_lobe_measure(const struct tl_lobe_source *source, float s, tl_lobe_response *response,
                                     const void *prefilter);

/* Chains by enum tl_chain_filter, at the level that tl_lobe_calibrate gives; then the slices of a region, and
 * the lobes of the whole environment. */
enum { TL_LOBE_SLICES = 5, TL_LOBE_WHOLE, TL_LOBE_METHODS };
extern const char *const tl_lobe_method_names[]; /* none gauss cosine box sqrt_cosine slices whole, NULL */

/* Direction i of `count`: corners, edges and middles of the cube's faces (26), then a spiral. */
vec3s tl_lobe_probe(int i, int count);

/* Figure 5: one method's errors over the exponents, over all directions. */
struct tl_lobe_curves {
    int cube_size;
    int direction_count;
    int region_count; /* of an even sky, for slices: the lit texel lies somewhere in its region */
    int exponent_count;
    const float *exponents;
};
struct tl_lobe_curve_point {
    double mean, worst, same_volume_mean, same_volume_worst, energy_low, energy_high;
};
void tl_lobe_curve(const struct tl_lobe_curves *curves, int method, struct tl_lobe_curve_point *out);

/* The same-volume error of a chain at the level that fits best, for each direction and exponent by itself:
 * what the filter could do if its calibration knew the direction. By exponent. */
void tl_lobe_min_error(const struct tl_lobe_curves *curves, int method, double *mean, double *worst);

/* Figure 4: the lobe along the great circle through a texel in the middle of a face, at `count` angles from
 * -pi to pi: what is shown and K_s. */
void tl_lobe_section(int cube_size, int method, float s, int count, float *shown, float *wanted);

#endif
