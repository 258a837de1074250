/* How far what a prefilter shows of one lit texel is from the cosine lobe: the ruler of the paper's figures 4
 * and 5 [002, section 5], with the metric written down. Pure.
 *
 * One texel of a cube sends light of power 1 (radiance 1 / solid angle). Then E(d, s) is the filter's lobe,
 * and what it should be is K_s averaged over the texel:
 *
 *     error  = integral |E(d, s) - K| dd / integral K dd       over the sphere
 *     energy = integral E(d, s) dd / integral K dd
 *
 * by a quadrature that puts half as many directions again as the lobe has light into its tail. */
#ifndef TOILE_RENDER_PEM_LOBE_ERROR_H
#define TOILE_RENDER_PEM_LOBE_ERROR_H

#include "render/env/cube.h"

struct tl_lobe_error {
    double error, energy;
};

/* A texel of a cube, with directions and weights that stand for its area. */
#define TL_LOBE_SOURCE_POINTS 9
struct tl_lobe_source {
    int texel;   /* (face * size + y) * size + x */
    vec3s power; /* radiance that gives power 1, in all channels */
    vec3s points[TL_LOBE_SOURCE_POINTS];
    double weights[TL_LOBE_SOURCE_POINTS]; /* sum 1 */
};
struct tl_lobe_source tl_lobe_source(int size, vec3s direction);

/* What the filter shows in direction d, one channel. */
typedef double tl_lobe_response(const void *filter, vec3s direction);

struct tl_lobe_error tl_lobe_measure(const struct tl_lobe_source *source, float s, tl_lobe_response *response,
                                     const void *filter);

#endif
