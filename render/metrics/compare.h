/* How different two images are: relative RMSE, FLIP (LDR and HDR), largest difference. Pure.
 *
 * Linear RGB(A) float images of equal size. A pixel counts when alpha > 0 in either image; images without
 * alpha count whole. FLIP: Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images", and
 * 2021 for HDR; HDR exposures are found from covered pixels only, and a non-finite one is an error. */
#ifndef TOILE_RENDER_METRICS_COMPARE_H
#define TOILE_RENDER_METRICS_COMPARE_H

#include "assets/base/image.h"

struct tl_comparison {
    size_t covered;    /* pixels compared */
    double rel_rmse;   /* sqrt(mean (a - b)^2) / mean b over covered pixels and their three channels; infinite
                          against a black reference, unless equal */
    double flip_mean;  /* covered pixels */
    double flip_frame; /* whole frame */
    double max_abs;    /* largest channel difference */
    size_t worst;      /* the pixel of the largest square error, y * width + x */
    double
        worst_share; /* its part of the sum of square errors; 0 when images are equal. At an outline that one
                        image puts on the other side of a pixel's middle, a highlight may be all of it */
    bool hdr;        /* HDR-FLIP was used: a value above 1 in the reference, or asked for */
    double exposure_start, exposure_stop; /* HDR only, log2 */
};

/* `a` is tested, `b` the reference. Sizes that differ, NaN or Inf in either, or
 * no covered pixel at all are TL_INPUT errors; so is HDR against a reference that is half black, which has no
 * exposure. 8-bit images are decoded from sRGB. `hdr`:
 * -1 decides by content, 0 LDR, 1 HDR. `pixels_per_degree` <= 0 means FLIP's default, 67; else 10 to 1000. */
bool tl_image_compare(const tl_image *a, const tl_image *b, int hdr, double pixels_per_degree,
                      struct tl_comparison *out, tl_error *error);

#endif
