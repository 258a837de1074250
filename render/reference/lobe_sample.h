/* The cosine lobe K_s(axis, w) = (s + 1) / 2 pi cos^s: its value, and directions sampled from it.
 * Pure; threads: any. */
#ifndef TOILE_RENDER_REFERENCE_LOBE_SAMPLE_H
#define TOILE_RENDER_REFERENCE_LOBE_SAMPLE_H

#include <cglm/struct.h>

/* K_s, which is also the pdf of tl_lobe_sample, for a direction whose cosine with the axis is 1 - `off`. */
float tl_lobe_value(float exponent, float off);

/* A direction sampled from K_s about a unit axis by two numbers in [0, 1). `off` is 1 - its cosine: exact
 * where the cosine rounds to 1. */
vec3s tl_lobe_sample(vec3s axis, float exponent, double height, double turn, float *off);

#endif
