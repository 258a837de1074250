/* FLIP, the difference that a person sees when two images are flipped in place: a map in [0, 1].
 *
 * LDR: P. Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. Fairchild: "FLIP: A
 * Difference Evaluator for Alternating Images", HPG 2020. HDR: P. Andersson, J. Nilsson, P. Shirley, T.
 * Akenine-Moller: "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics 2021. Images are
 * linear Rec. 709, [height][width][3]; beyond the frame its last texels go on. Pure; bit-identical at any
 * thread count. */
#ifndef TOILE_RENDER_METRICS_FLIP_H
#define TOILE_RENDER_METRICS_FLIP_H

#include <stdbool.h>
#include <stddef.h>

/* 3840 pixels over 0.7 m, seen from 0.7 m. */
#define TL_FLIP_PIXELS_PER_DEGREE 67.0206

struct tl_flip_frame {
    int width, height;
    double pixels_per_degree;
};

/* Values are clamped to [0, 1]. `map` is [height][width]. */
void tl_flip_ldr(const struct tl_flip_frame *frame, const float *test, const float *reference, float *map);

/* The exposures, log2, at which the tone mapper shows the brightest and the median of `luminances` at 0.85.
 * False when either has none: when the median, or everything, is black. `luminances` is sorted in place. */
bool tl_flip_exposures(float *luminances, size_t count, double *start, double *stop);

/* The largest LDR-FLIP of each pixel over the exposures from start to stop, one stop apart or a little less.
 */
void tl_flip_hdr(const struct tl_flip_frame *frame, const float *test, const float *reference, double start,
                 double stop, float *map);

#endif
