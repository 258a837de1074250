/* The reflectance of an experiment whose cloths are drawn from samples (tl_experiment.sampled): files that
 * its rows name as "@samples.txt" (app/lab/experiments/picture.h). */
#ifndef TOILE_APP_LAB_GALLERY_SAMPLED_H
#define TOILE_APP_LAB_GALLERY_SAMPLED_H

#include "app/lab/experiments/picture.h"

/* Writes samples of the picture's own model over even light into its folder, in place of the last picture's.
 * Errors: TL_OUTPUT. */
bool tl_sampled_make(const struct tl_experiment_picture *picture, tl_error *error);

#endif
