/* FLIP, the perceived difference when two images are alternated in place, as a map in [0, 1].
 *
 * LDR after [Andersson et al. 2020], HDR after [Andersson et al. 2021]. Images are
 * linear Rec. 709, [height][width][3]; beyond the frame the outermost texels are repeated. Pure;
 * bit-identical at any number of threads. */
#ifndef TOILE_RENDER_METRICS_FLIP_H
#define TOILE_RENDER_METRICS_FLIP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* 3840 pixels over 0.7 m, seen from 0.7 m. */
#define TL_FLIP_PIXELS_PER_DEGREE 67.0206

struct tl_flip_frame {
    int width, height;
    double pixels_per_degree;
};

/* Bytes that the functions below take besides their arguments. */
uint64_t tl_flip_bytes(const struct tl_flip_frame *frame);

/* LDR-FLIP; values are clamped to [0, 1]. `map` is [height][width]. */
void tl_flip_ldr(const struct tl_flip_frame *frame, const float *test, const float *reference, float *map);

/* The exposures (log2) at which the tone mapper maps the maximum and the median of `luminances` to 0.85.
 * False if the median or all luminances are black. Sorts `luminances` in place. */
bool tl_flip_exposures(float *luminances, size_t count, double *start, double *stop);

/* HDR-FLIP: the maximum of LDR-FLIP per pixel over the exposures from start to stop, at most one stop
 * apart. */
void tl_flip_hdr(const struct tl_flip_frame *frame, const float *test, const float *reference, double start,
                 double stop, float *map);

#endif
