/* Image difference: relative RMSE, FLIP (LDR and HDR), largest difference; and FLIP over one object's pixels.
 * Pure; threads: any.
 *
 * Linear RGB(A) float images of equal size. A pixel counts if alpha > 0 in either image; images without alpha
 * count entirely. FLIP is that of flip.h. HDR exposures are computed from covered pixels only; an exposure
 * that is not finite is an error. */
#ifndef TOILE_RENDER_METRICS_COMPARE_H
#define TOILE_RENDER_METRICS_COMPARE_H

#include "assets/base/image.h"

struct tl_comparison {
    size_t covered;    /* pixels compared */
    double rel_rmse;   /* sqrt(mean (a - b)^2) / mean b over covered pixels and their three channels; infinite
                          against a black reference, unless equal */
    double flip_mean;  /* mean over the covered pixels */
    double flip_frame; /* mean over the whole frame */
    double max_abs;    /* largest channel difference */
    size_t worst;      /* the pixel of the largest square error, y * width + x */
    double worst_share; /* its fraction of the sum of square errors; 0 when the images are equal. It can be
                           large at an outline that the two images put on different sides of a pixel centre */
    bool hdr;           /* HDR-FLIP was used: requested, or a value above 1 in the reference */
    double exposure_start, exposure_stop; /* HDR only, log2 */
};

/* Compares `a` with the reference `b`. `hdr`: -1 decides by content, 0 LDR, 1 HDR. `pixels_per_degree`: 10 to
 * 1000; <= 0 means the default of FLIP, 67. 8-bit images are decoded from sRGB. Errors: TL_INPUT if the sizes
 * differ, if a value is not finite, if no pixel is covered, or for HDR if half of the reference is black, so
 * that it has no exposure. */
bool tl_image_compare(const tl_image *a, const tl_image *b, int hdr, double pixels_per_degree,
                      struct tl_comparison *out, tl_error *error);

/* The error of a picture in motion: LDR-FLIP over the pixels of one object, which is the garment. A mean over
 * all covered pixels is no measure of the garment, because most of them are the ground, which is easy. FLIP
 * is taken of the whole picture at the size at which it is shown, one pixel of the images for one of the
 * screen, and then only the object's pixels are averaged. What a person notices first is where the error is
 * largest, so the mean of the largest 5 % stands beside the mean. */
struct tl_object_error {
    size_t pixels;     /* the object's */
    double flip_mean;  /* over these pixels; NaN when there is none */
    double flip_worst; /* mean of the largest TL_FLIP_WORST_SHARE of them, their number rounded up; NaN when
                          there is none */
};
#define TL_FLIP_WORST_SHARE 0.05

/* Compares `a` with the reference `b`: pictures as shown (8 bit, sRGB), or linear ones, clamped to [0, 1].
 * The object's pixels are those where the first channel of `mask` is above one half: of 1 for F32, of 255 for
 * U8. `pixels_per_degree` as above. Errors: TL_INPUT if the three sizes differ or if a value of `a` or `b` is
 * not finite. */
bool tl_image_compare_object(const tl_image *a, const tl_image *b, const tl_image *mask,
                             double pixels_per_degree, struct tl_object_error *out, tl_error *error);

#endif
