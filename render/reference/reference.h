/* The oracle: what a pixel truly is (DESIGN 4), ray traced. No GL; none of the renderer's approximations: it
 * shares the scene, the camera and the definition of a material, and nothing else.
 *
 *     c*(x) = integral of L(w) V(x, w) [ kd K_1(n, w) + F ks K_s(r, w) ] dw
 *
 * The environment is constant over each of its own texels. These are stratified by power; each replicate
 * takes one direction from every stratum, and one from the glossy lobe for each of `lobe_samples`, combined
 * by the balance heuristic [Veach 1997]. Replicates are independent: their spread is the standard error.
 * Deterministic at any thread count. Ctrl-C keeps the replicates that are done. */
#ifndef TOILE_RENDER_REFERENCE_REFERENCE_H
#define TOILE_RENDER_REFERENCE_REFERENCE_H

#include "render/detail/options.h"
#include "render/reference/options.h"
#include "render/scene/frame.h"
#include "render/surfaces/ground.h"

struct tl_reference_request {
    const tl_frame *frame;
    const struct tl_ground *ground; /* not among the frame's surfaces; NULL: none */
    const struct tl_reference_params *params;
    const struct tl_detail_params *detail;
    int lobe;           /* enum tl_lobe (render/light/options.h) */
    bool reflect_scene; /* near mirrors see the lit scene; false: black */
    int width, height;  /* pixels */
    int supersample;    /* samples a pixel side */
};

struct tl_reference_report {
    int replicates; /* done */
    double
        standard_error; /* of the image: root of the mean square over covered pixels / mean, as rel_rmse is */
    size_t rays;
};

/* Image as tl_renderer_read gives it. False,
 * with TL_INTERRUPTED, only when nothing was finished. */
bool tl_reference_draw(const struct tl_reference_request *request, tl_image *out,
                       struct tl_reference_report *report, tl_error *error);

#endif
