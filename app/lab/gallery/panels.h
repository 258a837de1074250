/* Composes the pictures of the gallery: for each object a row of exact picture, technique and difference, and
 * beside them the square of the largest difference, magnified. Sizes in pixels. Pure. */
#ifndef TOILE_APP_LAB_GALLERY_PANELS_H
#define TOILE_APP_LAB_GALLERY_PANELS_H

#include "assets/base/image.h"

/* One drawn image of an object. */
struct tl_gallery_shot {
    tl_image light; /* F32 RGBA, premultiplied */
    tl_image shown; /* U8 RGB */
    double time_ms; /* CPU; NaN: not measured */
    double noise;   /* standard error of a ray-traced image, in the units of rel_rmse; else 0 */
};
/* Frees and zeroes. */
void tl_gallery_shot_release(struct tl_gallery_shot *shot);

struct tl_panel_row {
    const struct tl_gallery_shot *exact, *tested; /* of one size */
};

/* Whether a head fits above a picture of `side` pixels; one that is longer ends in an ellipsis. */
bool tl_panels_head_fits(int side, const char *text);

/* The composed picture of `count` rows of pictures of `side` pixels. `exact` and `tested` are the heads of
 * the columns. `end` is the upper end of the difference's scale (tl_panels_end). */
tl_image tl_panels_make(const struct tl_panel_row *rows, int count, int side, const char *exact,
                        const char *tested, double end);
void tl_panels_size(int count, int side, int *width, int *height);

/* The upper end of the scale for the differences of all rows: the first of 1, 2, 5 times a power of ten that
 * all but a thousandth of the covered pixels stay below; 0 when the images are equal. */
double tl_panels_end(const struct tl_panel_row *rows, int count);

/* Two rows of frames, those of the exact picture above those of the technique, and their heads. */
tl_image tl_panels_strip(const struct tl_gallery_shot *exact, const struct tl_gallery_shot *tested, int count,
                         int side, const char *exact_head, const char *tested_head);
void tl_panels_strip_size(int count, int side, int *width, int *height);

#endif
