/* A material of lobes that stands for measured reflectance where light comes from all around: regions of an
 * environment, suns, bounces. Every path lights sums of cosine lobes (lobe_fit.h), so none needs code for
 * it [Knuth et al. 2014, 6]. It is even light, a white surface, and up to two systems of threads (brdf.h):
 *
 *     f_r cos a ~ kd cos a / pi + F W_surface + sum over k of colour_k (1 - F) W_k,   W: bounded WARD
 *
 * The squares of the differences of f_r cos a are smallest, each times the solid angles of l and v for which
 * the sample stands, and times n.v: over the pixels of a round body seen from afar. Samples may lie as
 * densely as they like: cells of h and of l about h, within which each has the same share, give the angles;
 * dl dv = 4 h.l dh dd. Given the widths, colours follow exactly, one after the other;
 * widths are searched from a grid of starts. A second system of threads is there if it lessens the rest.
 *
 * Pure; the result is the same at any number of threads. */
#ifndef TOILE_RENDER_BRDF_TABLES_MEASURED_LOBES_H
#define TOILE_RENDER_BRDF_TABLES_MEASURED_LOBES_H

#include "assets/fabric/samples.h"
#include "render/brdf/brdf.h"

struct tl_measured_lobes {
    vec3s diffuse, specular;
    struct tl_gloss surface;
    int thread_count;
    struct tl_thread threads[TL_THREADS_MAX];
    double rel_rmse; /* of f_r cos a, over the pixels of a round body */
};

/* Bounds the rest. Under a studio's light fits within it erred by 8 % (relative RMSE) at most, those beyond
 * by 11 to 60 % (tests/render/brdf/test_measured_lobes.c). */
#define TL_MEASURED_LOBES_GOOD 0.28

struct tl_measured_lobes tl_measured_lobes_fit(const struct tl_reflectance_samples *samples);

/* Sets what reflects light, on both sides; `rotation` and what lies over the cloth stay. */
void tl_measured_lobes_set(const struct tl_measured_lobes *lobes, tl_material *material);

#endif
