/* The difference between a prefilter's response to one lit texel and the cosine lobe: the measure of [Knuth
 * et al. 2014, figures 4 and 5], with an explicit metric. Pure; results do not depend on the number of
 * threads.
 *
 * One texel of a cube emits power 1. The prefiltered radiance in direction d, E(d, s), is the response. The
 * exact response is K_s averaged over the texel:
 *
 *     error       = integral |E - K| dd / integral K dd             over the whole sphere
 *     energy      = integral E dd / integral K dd
 *     same volume = integral |E / energy - K| dd / integral K dd
 *     radial      = integral |c E^3 - K^3| dd / integral K^3 dd     with c so that both have one volume
 *
 * `error` measures the light of a pixel, `same volume` the shape alone. The paper compares lobes of the same
 * volume, of which it plots sections of "3D radial plots", and does not state whether the volume is that of
 * the light or that of the plotted solid, r^3 / 3 over directions: `radial` is the latter. */
#ifndef TOILE_RENDER_PEM_LOBE_ERROR_H
#define TOILE_RENDER_PEM_LOBE_ERROR_H

#include "render/env/cube.h"

/* The four integrals above. */
struct tl_lobe_error {
    double error, energy, same_volume, radial;
};

/* A texel of a cube as a source, with directions and weights that represent its area. */
#define TL_LOBE_SOURCE_POINTS 9
struct tl_lobe_source {
    int texel;      /* (face * size + y) * size + x */
    float radiance; /* for which the power is 1 */
    vec3s points[TL_LOBE_SOURCE_POINTS];
    double weights[TL_LOBE_SOURCE_POINTS]; /* sum 1 */
};
/* The texel in a direction. */
struct tl_lobe_source tl_lobe_source(int cube_size, vec3s direction);

/* The prefiltered value of one channel in a direction. */
typedef double tl_lobe_response(const void *prefilter, vec3s direction);
/* Compares a response with K_s of the source. */
struct tl_lobe_error tl_lobe_measure(const struct tl_lobe_source *source, float s, tl_lobe_response *evaluate,
                                     const void *prefilter);

/* Methods: the chains of enum tl_chain_filter at the level of tl_lobe_calibrate, then the slices of a region
 * and the lobes of the whole environment. */
enum { TL_LOBE_SLICES = 5, TL_LOBE_WHOLE, TL_LOBE_METHODS };
extern const char *const tl_lobe_method_names[]; /* none gauss cosine box sqrt_cosine slices whole, NULL */

/* Direction i of `count`: corners, edges and centres of the cube's faces (26), then a spiral. */
vec3s tl_lobe_probe(int i, int count);

/* Figure 5: the errors of one method by exponent, over all directions. */
struct tl_lobe_curves {
    int cube_size;
    int direction_count;
    int region_count; /* for slices: regions of a uniform sky; the lit texel lies anywhere in its region */
    int exponent_count;
    const float *exponents;
};
struct tl_lobe_curve_point {
    double mean, worst, same_volume_mean, same_volume_worst, radial_mean, energy_low, energy_high;
};
/* Fills `out` [exponent_count]. */
void tl_lobe_curve(const struct tl_lobe_curves *curves, int method, struct tl_lobe_curve_point *out);

/* Errors by exponent: the same-volume error of a chain at the level that fits best for each direction and
 * exponent separately. It is the limit of what the filter can reach if the calibration knew the direction. */
void tl_lobe_min_error(const struct tl_lobe_curves *curves, int method, double *mean, double *worst);

/* Figure 4: the response and K_s along the great circle through a texel in the centre of a face, at `count`
 * angles from -pi to pi. */
void tl_lobe_section(int cube_size, int method, float s, int count, float *response, float *exact);

#endif
