/* A drawn image against the ray-traced reference, in every pixel: the same camera rays, the reference's own
 * shading points and light. Tiles of 4 x 4 pixels are traced with few rays; where the image differs most they
 * are traced again, with many. The noise of the rays is known from replicates and is subtracted.
 *
 * Results do not depend on the number of threads. Threads: the one of the GL context; OpenMP inside. */
#ifndef TOILE_APP_LAB_TRUTH_TRUTH_H
#define TOILE_APP_LAB_TRUTH_TRUTH_H

#include "render/renderer.h"

enum { TL_TRUTH_TILE = 4 }; /* pixels along a side */

struct tl_truth {
    double error;         /* of all covered pixels: relative RMSE less the reference's own; >= 0 */
    int worst_x, worst_y; /* the pixel that differs most */
    /* Of the light of all covered pixels together, and of those that show the garment (the frame's last
     * surface): the relative difference less three standard errors, of the worst channel. */
    double mean_error, garment_error;
    /* The tile that differs most: the difference of its mean from the reference's, less three standard
     * errors, relative to the sum of the reference's mean there and in the whole image; of the worst channel.
     */
    double tile_error;
    int tile_x, tile_y; /* its middle pixel */
    /* The block of 2 x 2 tiles all of which differ most: by how much the least of them does. Rims of light
     * that are thinner than a tile do not count here. */
    double patch_error;
    int patch_x, patch_y;
    bool has_outlines;  /* in two directions: else there is no displacement */
    vec2s displacement; /* of the image's outlines from the reference's, to the right and down, pixels */
};

/* Whether images of these settings estimate what the reference computes: other methods than `pem` leave
 * shadows out or replace them by one number. */
bool tl_truth_is_comparable(const struct tl_render_settings *settings);

/* Compares images of one size and of one frame that `renderer` has drawn with these settings, or with others
 * that only draw it another way. The reference is traced once for all. `out`: each figure of the image that
 * has it worst. Errors: false with TL_DEVICE if the reference's BVH cannot be built. */
bool tl_truth_compare(const tl_frame *frame, const struct tl_render_settings *settings,
                      const tl_renderer *renderer, const tl_image *const *images, int image_count,
                      struct tl_truth *out, tl_error *error);

#endif
