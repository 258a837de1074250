/* The reference renderer: the exact colour of a pixel (docs/inside.md, "What a pixel is") by ray tracing. It
 * uses no GL and none of the renderer's approximations; it shares the scene, the camera and the definition of
 * a material.
 *
 *     c*(x) = integral of L(w) V(x, w) [ kd K_1(n, w) + F ks K_s(r, w) ] dw
 *
 * The environment is constant over each of its own texels. These are stratified by power. Each replicate
 * takes one sample from every stratum and `lobe_samples` samples from the glossy lobe, combined by the
 * balance heuristic [Veach 1997]. Replicates are independent, so that their spread gives the standard error.
 * Deterministic at any number of threads. */
#ifndef TOILE_RENDER_REFERENCE_REFERENCE_H
#define TOILE_RENDER_REFERENCE_REFERENCE_H

#include "render/reference/request.h"

struct tl_reference_report {
    int replicates; /* finished */
    double
        standard_error; /* relative, of the image: root mean square over covered pixels / mean, as rel_rmse */
    size_t rays;
};

/* Draws the frame. The image has the format of tl_renderer_read; the caller releases it.
 *
 * Errors: false with TL_INTERRUPTED if an interrupt (config/base/interrupt.h) came before the first replicate
 * was finished; a later one keeps the finished replicates. TL_DEVICE if the BVH cannot be built. Threads: one
 * call at a time; OpenMP inside. */
bool tl_reference_draw(const struct tl_reference_request *request, tl_image *out,
                       struct tl_reference_report *report, tl_error *error);

#endif
